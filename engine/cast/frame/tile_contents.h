#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/cast/block_rays.h"
#include "engine/cast/frame/ground_points.h"
#include "engine/cast/frame/sun_tiles.h"
#include "engine/cast/frame/tile_pieces.h"
#include "engine/cast/lit_levels.h"
#include "engine/cast/ray_tile.h"
#include "engine/view/draw_list.h"
#include "engine/view/terrain_maps.h"

namespace reljef::cast {

/// What rays need of the streamed tiles of a terrain: made at first sight, kept while they are
/// drawn.
class TileContents {
public:
    struct Options {
        unsigned threads = 0;
        bool paints = true;     ///< false: for hits only
        bool is_curved = false; ///< on the ellipsoid: PlacedTiles::nodes order the tiles
        bool in_parts = false;  ///< the light of the sky, and that of the sun without shadows
    };

    /// The tiles of a list, placed; `rays`: in samples of the overview, on the ellipsoid their
    /// range and anchor. Precondition: all tiles are of one stream.
    PlacedTiles place(const view::DrawList& list, const PictureRays& rays, const Options& options,
                      view::FrameStats& stats);

    using SharedTile = std::shared_ptr<const scene::TerrainTile>;
    /// The parts of `above` without drawn tiles, beside the picture. `above`: the tiles above the
    /// drawn ones in the tree. Valid until the next frame.
    std::vector<SunSource> beside(const scene::TileBuilder& builder,
                                  std::span<const SharedTile> drawn,
                                  std::span<const SharedTile> above);

    /// Takes the light of a stream that was computed before.
    void add_light(const view::PreparedLight& prepared);

private:
    struct Content {
        std::weak_ptr<const scene::TerrainTile> owner;
        std::array<std::optional<RayTile>, max_tile_parts.x * max_tile_parts.y> pieces;
        std::optional<LitLevels> levels;
        std::optional<LitLevels> sun;                   // if these are only the sky's
        std::optional<LitGround> ground;                // for point lights and detail
        std::array<std::optional<RayTile>, 4> quarters; // TileContents::beside()
        std::optional<scene::TerrainLight> light;       // of the levels
        std::uint64_t drawn = 0;                        // the last frame
    };
    struct StreamLight {
        std::weak_ptr<const scene::TileStream> owner;
        scene::TerrainLight light;
        std::shared_ptr<const scene::TerrainIrradiance> irradiance;
    };

    // A tile without all that it needs.
    struct Missing {
        const scene::TerrainTile* tile = nullptr;
        Content* content = nullptr;
        bool needs_ground = false; // for point lights, or a detail texture
    };

    void forget_unused();
    /// The lowest height of the tiles of a list that are made.
    [[nodiscard]] float lowest_of(const view::DrawList& list) const;
    std::vector<Missing> find_missing(const view::DrawList& list,
                                      const std::optional<scene::TerrainLight>& light,
                                      const Options& options, view::FrameStats& stats);
    Content& content_of(const std::shared_ptr<const scene::TerrainTile>& tile);
    static void make_levels(const scene::TileBuilder& builder,
                            const scene::TerrainIrradiance* irradiance, bool in_parts,
                            const Missing& missing);
    void make(const view::DrawList& list, const Options& options, view::FrameStats& stats);
    static void make_pieces(const scene::TileBuilder& builder, const Missing& missing);
    static std::size_t bytes_of(const Content& content);
    /// `needs_ground`: for point lights or a detail texture.
    static void paint(const Content& content, glm::vec2 vertex, bool needs_ground,
                      PlacedTile& tile);
    const scene::TerrainIrradiance& irradiance_of(const scene::TerrainNode& terrain,
                                                  const scene::TerrainLight& light);

    std::map<const scene::TerrainTile*, Content> contents_;
    StreamLight light_;
    std::uint64_t frame_ = 0;
};

} // namespace reljef::cast
