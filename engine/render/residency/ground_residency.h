#pragma once

#include <map>
#include <memory>
#include <optional>

#include <glm/vec4.hpp>

#include "engine/core/result.h"
#include "engine/gl/texture.h"
#include "engine/render/residency/tile_residency.h"
#include "engine/view/draw_list.h"
#include "engine/view/frame_stats.h"
#include "engine/view/terrain_maps.h"

namespace reljef::render {

/// A terrain's view::ground_map(). Texture coordinate = sample · xy + zw.
struct ResidentGround {
    gl::Texture2D albedo;
    gl::Texture2D surface;
    glm::vec4 ground_from_sample{0.0F};
};
Result<ResidentGround> resident_ground(const view::GroundMap& map, glm::vec4 ground_from_sample,
                                       view::FrameStats& stats);

/// The surface detail of terrains in GPU memory: its tiles, and the maps of the ground, again when
/// the sun moves. The maps are also there for terrains that point lights reach.
class GroundResidency {
public:
    Result<void> prepare(const view::DrawList& list, view::FrameStats& stats);

    /// Precondition: prepared; the list shows detail on the terrain.
    [[nodiscard]] const TileResidency& tiles() const { return tiles_; }
    /// Precondition: the same, or point lights reach the terrain, which is in memory.
    [[nodiscard]] const ResidentGround& ground(const scene::TerrainNode& terrain) const;

private:
    struct Ground {
        std::weak_ptr<const scene::TerrainSurface> owner;
        std::optional<scene::TerrainLight> light;
        ResidentGround resident;
    };
    Result<void> prepare_tile(const scene::TerrainDetail& detail, view::FrameStats& stats);
    Result<void> prepare_ground(const view::DrawList& list, const scene::TerrainNode& terrain,
                                const glm::dmat4& world_from_local, view::FrameStats& stats);
    Result<void> prepare_lit_grounds(const view::DrawList& list, view::FrameStats& stats);

    TileResidency tiles_;
    std::map<const scene::TerrainNode*, Ground> grounds_;
};

} // namespace reljef::render
