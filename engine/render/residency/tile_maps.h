#pragma once

#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include <glm/vec4.hpp>

#include "engine/core/result.h"
#include "engine/gl/texture.h"
#include "engine/render/residency/ground_residency.h"
#include "engine/scene/streaming/tile_stream.h"
#include "engine/view/draw_list.h"

namespace reljef::render {

/// The lit map of a loaded tile, in parts if its technique casts shadows. Texture coordinate =
/// samples from the tile's first · xy + zw.
struct ResidentTileMaps {
    std::optional<gl::Texture2D> lit;
    std::optional<gl::Texture2D> sun; ///< the sun's part; then lit is the sky's
    glm::vec4 lit_from_sample{0.0F};
    std::optional<ResidentGround> ground; ///< for visible surface detail and point lights
};

/// The maps of loaded tiles in GPU memory, for each terrain that shows them. Made on first use, and
/// again when the sun moves. Dropped when the stream drops the tile or after some frames unused.
class TileMaps {
public:
    Result<void> prepare(const view::DrawList& list, view::FrameStats& stats);

    void add_light(const std::shared_ptr<scene::TileStream>& stream,
                   const scene::TerrainLight& light,
                   std::shared_ptr<const scene::TerrainIrradiance> irradiance);

    /// A stream's light, computed once; dropped with the stream or after some frames unused.
    const scene::TerrainIrradiance& irradiance_of(const std::shared_ptr<scene::TileStream>& stream,
                                                  const scene::TerrainLight& light);

    /// Precondition: a loaded tile of the prepared list.
    [[nodiscard]] const ResidentTileMaps& tile(const view::TileDraw& draw) const;

private:
    // Terrains that share a stream may be turned towards the sun differently.
    using Key = std::tuple<const scene::TerrainNode*, const scene::TileStream*, terrain::TreeTile>;
    struct Entry {
        std::weak_ptr<const scene::TerrainTile> owner;
        std::uint64_t drawn = 0; // last frame
        std::optional<scene::TerrainLight> light;
        ResidentTileMaps maps;
    };
    struct SharedLight {
        std::weak_ptr<scene::TileStream> owner;
        std::uint64_t shown = 0; // last frame
        scene::TerrainLight light;
        std::shared_ptr<const scene::TerrainIrradiance> irradiance;
    };
    static Key key_of(const view::TileDraw& draw) {
        return {draw.terrain, draw.terrain->stream.get(), draw.tile->id};
    }
    Entry& entry_of(const view::TileDraw& draw);
    Result<void> prepare_light(const view::DrawList& list, const view::TileDraw& draw, Entry& entry,
                               view::FrameStats& stats);
    Result<void> prepare_ground(const view::DrawList& list, const view::TileDraw& draw,
                                Entry& entry, view::FrameStats& stats);
    void forget_lights(const view::DrawList& list);

    std::uint64_t frame_ = 0;
    std::map<Key, Entry> entries_;
    std::vector<SharedLight> lights_;
};

} // namespace reljef::render
