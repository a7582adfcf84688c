#pragma once

#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/geometry.h"
#include "engine/scene/graph/terrain_node.h"
#include "engine/scene/streaming/tile_builder.h"
#include "engine/terrain/field/min_max_pyramid.h"

namespace reljef::scene {

/// Where a ray meets the ground.
struct GroundHit {
    double t = 0.0;         ///< along the ray
    glm::dvec3 world{0.0};  ///< local metres of the terrain
    glm::dvec3 sample{0.0}; ///< col and row of the surface, height in true metres
};

/// The ground that tiles of a stream show together: the finest at each place.
class GroundTiles {
public:
    using SharedTile = std::shared_ptr<const TerrainTile>;

    /// The builder of the tiles outlives this object.
    GroundTiles(const TileBuilder& builder, const std::vector<SharedTile>& tiles);

    /// The first place in `range` where a ray in local metres enters the ground, exactly. At the
    /// borders of tiles of different levels it may pass where their heights differ.
    std::optional<GroundHit> first_hit(const Ray& ray,
                                       reljef::Interval range = {
                                           0.0, std::numeric_limits<double>::infinity()});

    /// True metres at a sample of the overview; empty where there is no tile.
    [[nodiscard]] std::optional<double> height_at(glm::dvec2 overview_sample) const;

private:
    struct Part {
        SharedTile tile;
        bool shows_something = false;                  // parts of it may have no finer tiles
        std::optional<terrain::MinMaxPyramid> pyramid; // made for the first ray
    };
    struct CrossedTile {
        Part* part = nullptr;
        double entry = 0.0; // where the ray enters the tile's bounds
    };
    std::vector<CrossedTile> crossed_by(const Ray& ray, reljef::Interval range);
    [[nodiscard]] bool is_refined(terrain::TreeTile tile, glm::dvec2 vertex) const;
    std::optional<terrain::SurfaceHit> hit_of(Part& part, const Ray& ray,
                                              reljef::Interval range) const;

    const TileBuilder& builder_;
    std::map<terrain::TreeTile, Part> parts_;
};

/// The first place where a ray in local metres enters the ground: exactly, on the finest loaded
/// tiles of a streamed terrain (GroundTiles). Waits for nothing. Empty if the ray misses the ground
/// or is not finite.
std::optional<GroundHit> pick_ground(const TerrainNode& terrain, const Ray& ray);

} // namespace reljef::scene
