#include "engine/session/measuring/ground_measure.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "engine/scene/graph/ground_pick.h"
#include "engine/scene/streaming/tile_stream.h"
#include "engine/terrain/measure/sight.h"

namespace reljef::session {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

double height_or_nan(const scene::TerrainNode& terrain, glm::dvec3 world) {
    const auto point = ground_point(terrain, world);
    return point && !point->is_void ? point->height : none;
}

double step_of(const scene::TerrainNode& terrain, double distance, int max_points) {
    const glm::dvec2 spacing = terrain.surface->placement().spacing();
    const double reduction = terrain.stream != nullptr ? terrain.stream->maker().reduction() : 1.0;
    return std::max(0.5 * std::min(spacing.x, spacing.y) / reduction, distance / (max_points - 2));
}

std::vector<terrain::ProfilePoint> straight_profile(const scene::TerrainNode& terrain,
                                                    glm::dvec3 from, glm::dvec3 to,
                                                    int max_points) {
    const double distance = std::hypot(to.x - from.x, to.y - from.y);
    const int steps =
        std::max(1, static_cast<int>(std::ceil(distance / step_of(terrain, distance, max_points))));
    std::vector<terrain::ProfilePoint> points;
    for (int i = 0; i <= steps; ++i) {
        const double share = static_cast<double>(i) / steps;
        points.push_back({share * distance, height_or_nan(terrain, from + share * (to - from))});
    }
    return points;
}

// Upwards, and outwards too where that is not out of the face: of walls, leaning ones, and
// ceilings.
glm::dvec3 lifted(const terrain::Placement& placement, const PickedPlace& place, double lift) {
    const glm::dvec3 way = lift * placement.up(place.world);
    const double missing = terrain::sight_tolerance - glm::dot(way, place.normal);
    return place.world + way + std::max(0.0, missing) * place.normal;
}

} // namespace

std::optional<terrain::SurfacePoint> ground_point(const scene::TerrainNode& terrain,
                                                  glm::dvec3 world) {
    const scene::TerrainSurface& surface = *terrain.surface;
    const auto sample = surface.placement().sample_from_world(world);
    if (!sample) {
        return std::nullopt;
    }
    const auto there =
        terrain::surface_point(surface.heightfield(), surface.placement(), glm::dvec2(*sample));
    if (!there || terrain.stream == nullptr) {
        return there;
    }
    const auto found = terrain.stream->finest_at(glm::dvec2(*sample));
    return found ? terrain::surface_point(found->tile->heightfield, *found->tile->placement,
                                          found->place)
                 : there;
}

std::string point_text(const scene::TerrainNode& terrain, const PickedPlace& picked) {
    const glm::dvec3 world = picked.world;
    const auto place = terrain.surface->heightfield().georeference
                           ? terrain.surface->placement().geodetic_from_world(world)
                           : std::nullopt;
    const std::string where = place
                                  ? fmt::format("{:.6f}, {:.6f}", place->latitude, place->longitude)
                                  : fmt::format("x {:.2f} m, y {:.2f} m", world.x, world.y);
    const auto point = ground_point(terrain, world);
    if (!picked.object.empty()) {
        const double height = height_of(terrain, picked);
        return where + fmt::format(": height {:.1f} m on '{}'", height, picked.object) +
               (point ? fmt::format(", {:.1f} m above the ground", height - point->height) : "");
    }
    if (!point) {
        return where + ": beside the terrain";
    }
    const std::string aspect =
        point->aspect ? fmt::format("aspect {:.0f}\u00b0", *point->aspect) : "level";
    return fmt::format("{}: height {:.1f} m{}, slope {:.1f}\u00b0, {}", where, point->height,
                       point->is_void ? " (a filled void)" : "", point->slope, aspect);
}

Result<std::vector<terrain::ProfilePoint>>
ground_profile(const scene::TerrainNode& terrain, glm::dvec3 from, glm::dvec3 to, int max_points) {
    const terrain::Placement& placement = terrain.surface->placement();
    if (!terrain.surface->heightfield().georeference) {
        return straight_profile(terrain, from, to, max_points);
    }
    const auto start = placement.geodetic_from_world(from);
    const auto end = placement.geodetic_from_world(to);
    if (!start || !end) {
        return Error{"profile: a point beside the map of the Earth found"};
    }
    const double distance = geo::geodesic_distance(*start, *end);
    const auto places =
        terrain::geodesic_places(*start, *end, step_of(terrain, distance, max_points));
    if (!places) {
        return places.error();
    }
    std::vector<terrain::ProfilePoint> points;
    for (std::size_t i = 0; i < places->size(); ++i) {
        const auto world = placement.world_from_geodetic((*places)[i]);
        points.push_back(
            {distance * static_cast<double>(i) / static_cast<double>(places->size() - 1),
             world ? height_or_nan(terrain, *world) : none});
    }
    return points;
}

std::optional<PickedPlace> hidden_by(const TerrainScene& scene, const PickedPlace& from,
                                     const PickedPlace& to, double height) {
    const terrain::Placement& placement =
        scene.terrain->get<scene::TerrainNode>()->surface->placement();
    const double lift = placement.exaggeration() * std::max(height, terrain::sight_tolerance);
    const glm::dvec3 eye = lifted(placement, from, lift);
    const glm::dvec3 target = lifted(placement, to, lift);
    auto hit = pick_place(scene, {eye, target - eye});
    const bool is_between = hit && glm::distance(eye, hit->world) < glm::distance(eye, target);
    return is_between ? hit : std::nullopt;
}

} // namespace reljef::session
