#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "engine/core/result.h"
#include "engine/gl/texture_array.h"
#include "engine/render/residency/relief_maps.h"
#include "engine/render/residency/tile_maps.h"
#include "engine/view/draw_list.h"

namespace reljef::render {

/// A stream's tiles for rays. Each tile has the same layer in all arrays; see stream_tiles.glsl.
struct ResidentReliefTiles {
    StreamedSpace space;
    std::optional<gl::Texture2D> pages = {};
    std::optional<gl::TextureArray> heights = {};
    std::optional<gl::TextureArray> max_mipmaps = {}; ///< for exact and beams
    std::optional<gl::TextureArray> cones = {};       ///< for cone
    std::optional<gl::TextureArray> lit = {};         ///< of the sky only if there is `sun`
    std::optional<gl::TextureArray> sun = {};         ///< if rays cast the shadows
    std::optional<gl::TextureArray> albedo = {};      ///< for point lights
    std::optional<gl::TextureArray> normals = {};     ///< for point lights
};

/// The tiles of streams that rays search, in GPU memory, for each terrain that shows them. A tile
/// stays until its layer is needed, or the stream drops it. All are dropped after some frames
/// unused.
class ReliefTiles {
public:
    /// `with_light`: for pictures. Fails without GL memory.
    Result<void> prepare(const view::DrawList& list, bool with_light, TileMaps& lights,
                         view::FrameStats& stats);

    /// Precondition: a draw with tiles of the prepared list.
    [[nodiscard]] const ResidentReliefTiles& tiles(const view::TerrainDraw& draw) const;

private:
    using Tile = std::shared_ptr<const scene::TerrainTile>;
    // Light of a tile, or its albedo without a sun.
    struct Lit {
        std::optional<scene::TerrainLight> light;
        bool in_parts = false;

        friend bool operator==(const Lit&, const Lit&) = default;
    };
    static constexpr int no_layer = -1;
    static constexpr int min_layers = 64;
    struct Slot {
        std::weak_ptr<const scene::TerrainTile> owner;
        int layer = no_layer;
        std::uint64_t drawn = 0; // last frame
        bool has_heights = false;
        bool has_max = false;
        bool has_cones = false;
        bool has_ground = false;
        std::optional<Lit> lit = {};
    };
    struct Stream {
        std::weak_ptr<scene::TileStream> owner;
        std::uint64_t drawn = 0; // last frame
        int layers = 0;
        std::map<terrain::TreeTile, Slot> slots;
        std::vector<std::pair<terrain::TreeTile, glm::vec2>> shown; // by the pages
        ResidentReliefTiles resident;
    };
    struct Drawn {
        Tile tile;
        Slot* slot = nullptr;
    };

    Result<void> prepare(const view::DrawList& list, const view::TerrainDraw& draw, bool with_light,
                         TileMaps& lights, view::FrameStats& stats);
    [[nodiscard]] std::vector<Drawn> placed(Stream& stream, const view::TerrainDraw& draw) const;
    void place_new(Stream& stream) const;
    static Result<void> prepare_heights(Stream& stream, const std::vector<Drawn>& tiles,
                                        view::FrameStats& stats);
    static Result<void> prepare_search(Stream& stream, const std::vector<Drawn>& tiles,
                                       const scene::Technique& technique, view::FrameStats& stats);
    static Result<void> prepare_max(Stream& stream, const std::vector<Drawn>& tiles,
                                    view::FrameStats& stats);
    static Result<void> prepare_cones(Stream& stream, const std::vector<Drawn>& tiles,
                                      view::FrameStats& stats);
    static Result<void> prepare_light_arrays(Stream& stream, const std::vector<Drawn>& tiles,
                                             const Lit& lit);
    static Result<void> prepare_light(Stream& stream, const std::vector<Drawn>& tiles,
                                      const scene::TileBuilder& builder, const Lit& lit,
                                      const scene::TerrainIrradiance* irradiance,
                                      view::FrameStats& stats);
    static Result<void> prepare_ground(Stream& stream, const std::vector<Drawn>& tiles,
                                       const scene::TileBuilder& builder, view::FrameStats& stats);
    static Result<void> prepare_pages(Stream& stream, const std::vector<Drawn>& tiles,
                                      view::FrameStats& stats);

    // Terrains that share a stream have other tiles, pages, maps and light.
    using Key = std::pair<const scene::TerrainNode*, const scene::TileStream*>;
    static Key key_of(const view::TerrainDraw& draw) {
        return {draw.terrain, draw.terrain->stream.get()};
    }

    std::uint64_t frame_ = 0;
    std::map<Key, Stream> streams_;
};

} // namespace reljef::render
