#include "engine/view/grain_view.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/geo/georeference.h"
#include "engine/material/grain_map.h"
#include "engine/scene/streaming/tile_stream.h"

namespace reljef::view {
namespace {

// Elevation data show no waves that are shorter than two samples. Those of a pattern are up to a
// fifth of its width long.
constexpr double samples_a_width = 10.0;
// The shortest waves of a pattern are 1/47 of it, and the longest of the next one half as long.
constexpr double widths_a_width = 17.0;
constexpr double narrowest = 0.5; // metres

// Metres. Wider ones are hills, which coarse data would show.
constexpr double widest = 1500.0;

double finest_spacing(const scene::TerrainNode& terrain) {
    if (terrain.stream != nullptr) {
        return terrain.stream->maker().spacing(0);
    }
    const glm::dvec2 spacing = terrain.surface->placement().spacing();
    return std::max(spacing.x, spacing.y);
}

// Metres.
double first_width(const scene::TerrainNode& terrain) {
    return std::min(samples_a_width * finest_spacing(terrain), widest);
}

// The sample of the terrain's surface that is nearest to the eye.
glm::dvec3 sample_near(const scene::TerrainNode& terrain, glm::dvec3 local_eye) {
    const Grid<float>& heights = terrain.surface->heightfield().heights;
    const glm::dvec2 last(heights.cols() - 1, heights.rows() - 1);
    const auto sample = terrain.surface->placement().sample_from_world(local_eye);
    return {glm::clamp(sample ? glm::dvec2(*sample) : 0.5 * last, glm::dvec2(0.0), last), 0.0};
}

glm::dmat3 metres_per_sample(const terrain::Placement& placement, glm::dvec3 sample) {
    glm::dmat3 metres(1.0);
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 half(0.0);
        half[axis] = 0.5;
        metres[axis] =
            placement.world_from_sample(sample + half) - placement.world_from_sample(sample - half);
    }
    return metres;
}

// Dimmer light shows no kind of ground.
constexpr float min_light = 1e-3F;

glm::vec3 reflected_by_level_ground(const std::optional<scene::Light>& sun, glm::dvec3 up) {
    if (!sun) {
        return glm::vec3(1.0F);
    }
    const auto sine = static_cast<float>(std::max(glm::dot(up, scene::to_light(*sun)), 0.0));
    return glm::max(sine * sun->color + sun->ambient, glm::vec3(min_light));
}

} // namespace

glm::dvec3 turned(glm::dvec3 world) {
    const glm::dvec2 turn(GrainView::turn);
    return {turn.x * world.x + turn.y * world.y, turn.x * world.y - turn.y * world.x, world.z};
}

bool shows_grain(const DrawList& list, const scene::TerrainNode& terrain, double distance) {
    const glm::dvec2 metres(scene::metres_a_pixel(list.camera, list.size));
    const double texel = first_width(terrain) / material::GrainMap::side;
    return scene::shown_grain(terrain) > 0.0F &&
           metres.x + metres.y * distance < std::exp2(GrainView::unseen_level) * texel;
}

GrainView grain_view(const DrawList& list, const scene::TerrainNode& terrain,
                     const glm::dmat4& world_from_local) {
    const glm::dvec3 eye = turned(list.camera.eye);
    const glm::dmat3 directions(world_from_local);
    const glm::dvec3 local_eye(glm::inverse(world_from_local) * glm::dvec4(list.camera.eye, 1.0));
    const terrain::Placement& placement = terrain.surface->placement();
    GrainView view;
    view.strength = scene::shown_grain(terrain);
    const glm::dvec3 up = glm::normalize(directions * placement.up(local_eye));
    view.up = glm::vec3(turned(up));
    view.level_light = reflected_by_level_ground(list.sun, up);
    if (const auto place = placement.geodetic_from_world(local_eye);
        place && placement.kind() == terrain::PlacementKind::ellipsoid) {
        view.radius = geo::mean_radius_of_earth + place->height;
    }
    view.metres_per_sample =
        directions * metres_per_sample(placement, sample_near(terrain, local_eye));
    for (int axis = 0; axis < 3; ++axis) {
        view.metres_per_sample[axis] = turned(view.metres_per_sample[axis]);
    }
    double width = first_width(terrain);
    double copies = GrainView::copies;
    do {
        view.patterns.at(static_cast<std::size_t>(view.pattern_count++)) = {
            glm::vec3(copies * glm::fract(eye / (copies * width))), 1.0 / width};
        width /= widths_a_width;
        copies = 1.0;
    } while (width > narrowest && view.pattern_count < GrainView::max_patterns);
    return view;
}

} // namespace reljef::view
