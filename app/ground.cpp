#include "app/ground.h"

#include <algorithm>

#include <glm/geometric.hpp>

#include "engine/scene/tile_stream.h"

namespace reljef::app {
namespace {

constexpr double clearance_in_widths = 1e-3;
constexpr double most_clearance = 0.5; // metres: a flight a metre above the ground is none too low

// The sample below or above a place; nothing beside the terrain.
std::optional<glm::dvec3> sample_of(const scene::TerrainSurface& surface, glm::dvec3 world) {
    const Grid<float>& heights = surface.heightfield().heights;
    const auto sample = surface.placement().sample_from_world(world);
    const bool inside = sample && sample->x >= 0.0 && sample->y >= 0.0 &&
                        sample->x <= heights.cols() - 1 && sample->y <= heights.rows() - 1;
    return inside ? sample : std::nullopt;
}

// The highest that any triangulation of a cell and the bilinear surface have at a sample.
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

// Heights around a place, and the place on them.
struct Around {
    std::shared_ptr<const scene::StreamedTile> tile; // null: of the whole terrain
    GridView<const float> heights;
    glm::dvec2 place;
};

Around heights_around(const scene::TerrainNode& terrain, glm::dvec2 sample) {
    auto found = terrain.stream != nullptr ? terrain.stream->finest_at(sample) : std::nullopt;
    if (!found) {
        return {{}, terrain.surface->heightfield().heights.view(), sample};
    }
    const auto heights = found->tile->heights.view();
    return {std::move(found->tile), heights, found->place};
}

double highest_at(const scene::TerrainNode& terrain, glm::dvec2 sample) {
    const Around there = heights_around(terrain, sample);
    return highest_of(there.heights, there.place);
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

std::optional<scene::GroundAt> ground_at(const scene::TerrainNode& terrain, double x, double y) {
    const terrain::Placement& placement = terrain.surface->placement();
    const auto height = scene::height_at(terrain, x, y);
    const auto sample = height ? placement.sample_from_world({x, y, *height}) : std::nullopt;
    if (!sample) {
        return std::nullopt;
    }
    const double highest = highest_at(terrain, glm::dvec2(*sample));
    const double z = placement.world_from_sample({sample->x, sample->y, highest}).z;
    return scene::GroundAt{*height, std::max(*height, z)};
}

double least_clearance(const TerrainScene& scene) {
    const glm::dvec3 size = scene.bounds.size();
    return std::min(most_clearance, clearance_in_widths * std::max(size.x, size.y));
}

double keep_above_ground(TerrainScene& scene) {
    const auto& terrain = *scene.terrain->get<scene::TerrainNode>();
    const terrain::Placement& placement = terrain.surface->placement();
    auto& camera = *scene.camera->get<scene::Camera>();
    const auto sample = sample_of(*terrain.surface, camera.eye);
    if (!sample) {
        return 0.0;
    }
    const double least = highest_at(terrain, glm::dvec2(*sample)) +
                         least_clearance(scene) / placement.exaggeration();
    if (!(sample->z < least)) {
        return 0.0;
    }
    const glm::dvec3 rise = placement.world_from_sample({sample->x, sample->y, least}) - camera.eye;
    camera.eye += rise;
    camera.look += rise;
    return glm::length(rise);
}

} // namespace reljef::app
