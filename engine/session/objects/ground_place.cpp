#include "engine/session/objects/ground_place.h"

#include <cmath>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace reljef::session {
namespace {

// Samples. Places on Earth round to about 1e-8 m, 16 times the last bit of the Earth's radius;
// samples are at least a centimetre wide.
constexpr double border_rounding = 1e-6;

// The place among the samples, without a height.
Result<glm::dvec2> sample_of(const scene::TerrainSurface& surface, const GroundPlace& place) {
    const terrain::Heightfield& field = surface.heightfield();
    const terrain::Placement& placement = surface.placement();
    std::optional<glm::dvec3> world(glm::dvec3(place.at, 0.0));
    if (field.georeference) {
        if (std::abs(place.at.x) > 90.0 || std::abs(place.at.y) > 360.0) {
            return misplaced(place, "no place on Earth", "a latitude and a longitude in degrees");
        }
        world = placement.world_from_geodetic({place.at.x, place.at.y, 0.0});
    }
    const auto sample = world ? placement.sample_from_world(*world) : std::nullopt;
    const glm::dvec2 last(field.heights.cols() - 1, field.heights.rows() - 1);
    if (sample) {
        const glm::dvec2 inside = glm::clamp(glm::dvec2(*sample), glm::dvec2(0.0), last);
        if (glm::distance(inside, glm::dvec2(*sample)) <= border_rounding) {
            return inside;
        }
    }
    return misplaced(place, "a place outside the terrain", "one on " + surface.terrain().name);
}

} // namespace

Error misplaced(const GroundPlace& place, const std::string& found, const std::string& expected) {
    return Error{fmt::format("{}: at {},{} {} found, {} was expected", place.name, place.at.x,
                             place.at.y, found, expected)};
}

Result<glm::dvec3> ground_at(const scene::TerrainSurface& surface, const GroundPlace& place) {
    const auto sample = sample_of(surface, place);
    if (!sample) {
        return sample.error();
    }
    const terrain::Heightfield& field = surface.heightfield();
    if (!place.ground_height && terrain::uses_void(field, *sample)) {
        return misplaced(place, "a void", "ground with a height");
    }
    const double height =
        place.ground_height.value_or(terrain::bilinear_height(field.heights.view(), *sample));
    return surface.placement().world_from_sample({*sample, height});
}

} // namespace reljef::session
