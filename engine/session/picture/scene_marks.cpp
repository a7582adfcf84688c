#include "engine/session/picture/scene_marks.h"

#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include "engine/session/ground.h"
#include "engine/terrain/field/tint.h"

namespace reljef::session {
namespace {

constexpr int legend_stops = 129;

const scene::TerrainNode& marked_terrain(const TerrainScene& scene) {
    return *scene.terrain->get<scene::TerrainNode>();
}

bool brings_colors(const TerrainScene& scene) {
    const terrain::Terrain& terrain = marked_terrain(scene).surface->terrain();
    return !terrain.color.empty() || (scene.source != nullptr && scene.source->imagery != nullptr);
}

bool hides_ramp(const TerrainScene& scene) {
    return brings_colors(scene) && marked_terrain(scene).surface->imagery_share() >= 1.0;
}

std::string legend_note(const TerrainScene& scene) {
    const char* const reason =
        !scene.models.empty() ? "models have no colours by height"
        : hides_ramp(scene)   ? "the terrain's own colours or imagery hide those by height; an "
                                "--imagery-share below 1 shows both"
                              : "all heights are equal";
    return fmt::format("no legend is drawn: {}", reason);
}

double north_of(const TerrainScene& scene, const scene::Camera& camera) {
    const scene::TerrainSurface& surface = *marked_terrain(scene).surface;
    const bool is_perspective = camera.projection == scene::ProjectionKind::perspective;
    const glm::dvec3 place = is_perspective ? camera.eye : camera.target;
    scene::Compass compass;
    if (surface.heightfield().georeference) {
        compass = {surface.placement().up(place), surface.placement().north(place)};
    }
    // Steep views have the azimuth of up in the picture.
    const scene::ViewAxes axes = scene::view_axes(camera);
    const double rise = glm::dot(axes.forward, compass.up);
    const bool is_steep = std::abs(rise) > std::abs(glm::dot(axes.up, compass.up));
    const glm::dvec3 ahead = is_steep ? -std::copysign(1.0, rise) * axes.up : axes.forward;
    return -scene::heading_of(ahead, compass);
}

} // namespace

std::vector<view::LegendStop> legend_of(const TerrainScene& scene) {
    const scene::TerrainSurface& surface = *marked_terrain(scene).surface;
    const terrain::HeightRange range = surface.heightfield().range;
    if (!scene.models.empty() || hides_ramp(scene) || !(range.low < range.high)) {
        return {};
    }
    const terrain::HeightTint tint(surface.ramp(), surface.heightfield());
    std::vector<view::LegendStop> stops;
    for (int i = 0; i < legend_stops; ++i) {
        const double height = range.low + (range.high - range.low) * i / (legend_stops - 1);
        stops.push_back({height, tint.at(height, glm::vec2(0.0F))});
    }
    return stops;
}

SceneMarks marks_of(const TerrainScene& scene, const io::MarksDescription& chosen,
                    glm::ivec2 size) {
    SceneMarks found;
    if (chosen == io::MarksDescription()) {
        return found;
    }
    const glm::ivec2 min = view::min_marked_picture;
    if (glm::any(glm::lessThan(size, min))) {
        found.notes.push_back(fmt::format("no marks are drawn: {}x{} pixels have no room for them, "
                                          "{}x{} have",
                                          size.x, size.y, min.x, min.y));
        return found;
    }
    const scene::Camera& camera = *scene.camera->get<scene::Camera>();
    if (chosen.legend) {
        found.marks.legend = legend_of(scene);
        if (found.marks.legend.empty()) {
            found.notes.push_back(legend_note(scene));
        }
    }
    if (chosen.scale) {
        const auto metres = metres_per_pixel(marked_terrain(scene), camera, size.y);
        if (metres && *metres > 0.0) {
            found.marks.scale = {*metres, camera.projection == scene::ProjectionKind::orthographic};
        } else {
            found.notes.emplace_back("no scale bar is drawn: in perspective it holds in the "
                                     "picture's middle, which shows no ground");
        }
    }
    if (chosen.north) {
        found.marks.north = north_of(scene, camera);
    }
    return found;
}

} // namespace reljef::session
