#include "engine/session/ground.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "engine/geo/georeference.h"
#include "engine/scene/graph/ground_pick.h"
#include "engine/scene/streaming/tile_stream.h"

namespace reljef::session {
namespace {

constexpr double clearance_in_widths = 1e-3;
constexpr double max_clearance = 0.5; // metres
// Rounding error of heights in the scene, metres; and at most this part of a side of the terrain:
// far less than a sample.
constexpr double ground_rounding = 1e-3;
constexpr double rounding_in_sides = 1e-6;

// The sample below or above a place; empty off the terrain.
std::optional<glm::dvec3> sample_of(const scene::TerrainSurface& surface, glm::dvec3 world) {
    const Grid<float>& heights = surface.heightfield().heights;
    const auto sample = surface.placement().sample_from_world(world);
    const bool inside = sample && sample->x >= 0.0 && sample->y >= 0.0 &&
                        sample->x <= heights.cols() - 1 && sample->y <= heights.rows() - 1;
    return inside ? sample : std::nullopt;
}

// The highest point of the bilinear surface and of both triangulations of its cell at a sample.
double highest_of(GridView<const float> heights, glm::dvec2 sample) {
    const int col = std::clamp(static_cast<int>(sample.x), 0, heights.cols() - 2);
    const int row = std::clamp(static_cast<int>(sample.y), 0, heights.rows() - 2);
    const double u = std::clamp(sample.x - col, 0.0, 1.0);
    const double v = std::clamp(sample.y - row, 0.0, 1.0);
    const double h00 = heights(col, row);
    const double h10 = heights(col + 1, row);
    const double h01 = heights(col, row + 1);
    const double h11 = heights(col + 1, row + 1);
    const double falling =
        u > v ? h00 + u * (h10 - h00) + v * (h11 - h10) : h00 + v * (h01 - h00) + u * (h11 - h01);
    const double rising = u + v < 1.0 ? h00 + u * (h10 - h00) + v * (h01 - h00)
                                      : h11 + (1.0 - u) * (h01 - h11) + (1.0 - v) * (h10 - h11);
    return std::max({falling, rising, terrain::bilinear_height(heights, sample)});
}

// A grid of heights and a place on it.
struct Around {
    std::shared_ptr<const scene::TerrainTile> tile; // null: the whole terrain
    GridView<const float> heights;
    glm::dvec2 place;
};

Around heights_around(const scene::TerrainNode& terrain, glm::dvec2 sample) {
    auto found = terrain.stream != nullptr ? terrain.stream->finest_at(sample) : std::nullopt;
    if (!found) {
        return {{}, terrain.surface->heightfield().heights.view(), sample};
    }
    const auto heights = found->tile->heightfield.heights.view();
    return {std::move(found->tile), heights, found->place};
}

double highest_at(const scene::TerrainNode& terrain, glm::dvec2 sample) {
    const Around there = heights_around(terrain, sample);
    return highest_of(there.heights, there.place);
}

// The vector to another height along the local vertical.
glm::dvec3 way_up(const terrain::Placement& placement, glm::dvec3 sample, double height) {
    return placement.world_from_sample({sample.x, sample.y, height}) -
           placement.world_from_sample(sample);
}

std::string metres_text(double metres) {
    return metres < 10.0 ? fmt::format("{:.2g}", metres) : fmt::format("{:.1f}", metres);
}

double longest_side(const Box& box) {
    const glm::dvec3 size = box.size();
    return std::max({size.x, size.y, size.z});
}

} // namespace

std::optional<double> height_above_ground(const scene::TerrainNode& terrain, glm::dvec3 eye) {
    const auto sample = sample_of(*terrain.surface, eye);
    if (!sample) {
        return std::nullopt;
    }
    const Around there = heights_around(terrain, glm::dvec2(*sample));
    return sample->z - terrain::bilinear_height(there.heights, there.place);
}

std::optional<scene::GroundBelow> ground_below(const scene::TerrainNode& terrain, glm::dvec3 eye) {
    const auto sample = sample_of(*terrain.surface, eye);
    if (!sample) {
        return std::nullopt;
    }
    const Around there = heights_around(terrain, glm::dvec2(*sample));
    const double surface = terrain::bilinear_height(there.heights, there.place);
    const double exaggeration = terrain.surface->placement().exaggeration();
    return scene::GroundBelow{exaggeration * (sample->z - surface),
                              exaggeration * (highest_of(there.heights, there.place) - surface)};
}

glm::dvec3 above_ground(const scene::TerrainNode& terrain, glm::dvec3 eye, double clearance) {
    const auto ground = ground_below(terrain, eye);
    const double missing = ground ? ground->highest + clearance - ground->height : 0.0;
    return missing > 0.0 ? eye + missing * terrain.surface->placement().up(eye) : eye;
}

std::optional<PickedPlace> pick_place(const TerrainScene& scene, const Ray& ray) {
    const auto ground = scene::pick_ground(*scene.terrain->get<scene::TerrainNode>(), ray);
    const double end = ground ? ground->t : std::numeric_limits<double>::infinity();
    if (const auto on_mesh = scene.scene.pick_mesh(ray, {0.0, end})) {
        return PickedPlace{on_mesh->world, scene::object_name(*on_mesh->node), on_mesh->normal};
    }
    return ground ? std::optional(PickedPlace{ground->world}) : std::nullopt;
}

double height_of(const scene::TerrainNode& terrain, const PickedPlace& place) {
    const terrain::Placement& placement = terrain.surface->placement();
    const auto sample = placement.sample_from_world(place.world);
    if (!sample) {
        return place.world.z;
    }
    const auto above =
        place.object.empty() ? std::nullopt : height_above_ground(terrain, place.world);
    return above ? sample->z + (placement.exaggeration() - 1.0) * *above : sample->z;
}

std::optional<double> metres_per_pixel(const scene::TerrainNode& terrain,
                                       const scene::Camera& camera, int pixels_high) {
    if (camera.projection == scene::ProjectionKind::orthographic) {
        return camera.view_height / pixels_high;
    }
    const auto hit = scene::pick_ground(terrain, {camera.eye, scene::view_axes(camera).forward});
    return hit ? std::optional(2.0 * hit->t * std::tan(0.5 * glm::radians(camera.vertical_fov)) /
                               pixels_high)
               : std::nullopt;
}

double min_clearance(const TerrainScene& scene) {
    const glm::dvec3 size = scene.bounds.size();
    return std::min(max_clearance, clearance_in_widths * std::max(size.x, size.y));
}

double keep_above_ground(TerrainScene& scene) {
    const auto& terrain = *scene.terrain->get<scene::TerrainNode>();
    const terrain::Placement& placement = terrain.surface->placement();
    auto& camera = *scene.camera->get<scene::Camera>();
    const auto sample = sample_of(*terrain.surface, camera.eye);
    if (!sample) {
        return 0.0;
    }
    const double min_height =
        highest_at(terrain, glm::dvec2(*sample)) + min_clearance(scene) / placement.exaggeration();
    if (!(sample->z < min_height)) {
        return 0.0;
    }
    const glm::dvec3 rise = way_up(placement, *sample, min_height);
    camera.eye += rise;
    camera.target += rise;
    return glm::length(rise);
}

Lift lift_of(const scene::TerrainNode& terrain, glm::dvec3 eye, double clearance) {
    const scene::TerrainSurface& surface = *terrain.surface;
    const auto sample = sample_of(surface, eye);
    if (!sample || terrain::uses_void(surface.heightfield(), glm::dvec2(*sample))) {
        return {};
    }
    const double exaggeration = surface.placement().exaggeration();
    const Around there = heights_around(terrain, glm::dvec2(*sample));
    const double ground = terrain::bilinear_height(there.heights, there.place);
    const double depth = exaggeration * (ground - sample->z);
    const double rounding =
        std::min(ground_rounding, rounding_in_sides * longest_side(surface.bounds()));
    if (!(depth > rounding && std::isfinite(depth))) {
        return {};
    }
    const double highest = highest_of(there.heights, there.place);
    Lift lift;
    lift.depth = depth;
    lift.way = way_up(surface.placement(), *sample, highest + clearance / exaggeration);
    lift.metres = glm::length(lift.way);
    return lift;
}

Lift lift_camera(TerrainScene& scene) {
    auto& camera = *scene.camera->get<scene::Camera>();
    if (camera.projection == scene::ProjectionKind::orthographic) {
        return {};
    }
    const auto& terrain = *scene.terrain->get<scene::TerrainNode>();
    const Lift lift = lift_of(terrain, camera.eye, min_clearance(scene));
    camera.eye += lift.way;
    camera.target += lift.way;
    return lift;
}

std::string lift_note(const Lift& lift, std::string_view what) {
    return fmt::format("{}: {} m below the ground: lifted to {} m above it; "
                       "--allow-underground keeps it",
                       what, metres_text(lift.depth), metres_text(lift.metres - lift.depth));
}

std::optional<std::string> geoid_note(const TerrainScene& scene, const SourceOptions& terrain) {
    const scene::TerrainSurface& surface = *scene.terrain->get<scene::TerrainNode>()->surface;
    const auto& georeference = surface.heightfield().georeference;
    if (surface.placement().kind() != terrain::PlacementKind::ellipsoid || !georeference ||
        geo::is_ellipsoidal(georeference->vertical_datum)) {
        return std::nullopt;
    }
    const std::string& name = surface.terrain().name;
    const std::string& datum = georeference->vertical_datum;
    if (georeference->geoid) {
        return datum.empty() || geo::is_egm96(datum)
                   ? std::nullopt
                   : std::optional(fmt::format("{}: its heights count from \"{}\": taken as from "
                                               "the geoid {}, whatever lies between",
                                               name, datum, georeference->geoid->name()));
    }
    if (terrain.geoid == "none") {
        return std::nullopt;
    }
    return fmt::format("{}: its heights count from {}, and no geoid is applied: they are drawn "
                       "from the ellipsoid on; --geoid FILE names one",
                       name, datum.empty() ? "a zero that it does not name" : '"' + datum + '"');
}

} // namespace reljef::session
