#include "engine/render/residency/relief_tiles.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

#include <glm/common.hpp>

#include "engine/core/check.h"
#include "engine/render/residency/uploads.h"
#include "engine/render/shaders/bindings.h"
#include "engine/render/shaders/relief_options.h"
#include "engine/render/triangles/resident_mesh.h"
#include "engine/terrain/tree/tile_error.h"

namespace reljef::render {
namespace {

using Tiles = std::span<const std::shared_ptr<const scene::TerrainTile>>;

constexpr int page_cells = bindings::page_cells;
constexpr int vertices_a_side = page_cells + 1;
static_assert(page_cells == terrain::tree_tile_cells);
static_assert(gl::max_layers >= view::max_relief_tiles);

// Frames that the tiles of a stream stay unused.
constexpr std::uint64_t kept_frames_of_stream = 8;

// Repeats the last column and row up to the full size.
template <class T> Grid<T> extended(const Grid<T>& grid, int side) {
    Grid<T> whole(side, side);
    for (int row = 0; row < side; ++row) {
        for (int col = 0; col < side; ++col) {
            whole(col, row) = grid.clamped(col, row);
        }
    }
    return whole;
}

// Cells of the tile per metre of height.
Grid<glm::vec2> cones_of(const scene::TerrainTile& tile) {
    check(tile.cones != nullptr, "tiles with cones were expected");
    const auto heights = tile.heightfield.heights.samples();
    const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
    const float range = *high > *low ? *high - *low : 1.0F;
    Grid<glm::vec2> texels = cone_texels(*tile.cones);
    for (glm::vec2& cone : texels.samples()) {
        cone /= range;
    }
    return extended(texels, page_cells);
}

int texels_a_cell(const scene::TerrainTile& tile) {
    return std::max(1, (tile.albedo.cols() - 1) / tile.cells.x);
}

float highest_of(const scene::TerrainTile& tile) {
    float highest = tile.blocks(0, 0).high;
    for (const terrain::MinMax& block : tile.blocks.samples()) {
        highest = std::max(highest, block.high);
    }
    return highest;
}

// As stream_tiles.glsl: tile_of_page.
float packed_tile(const scene::TerrainTile& tile, int layer, int finest) {
    const int texel_level = std::countr_zero(static_cast<unsigned>(texels_a_cell(tile)));
    return static_cast<float>(layer | (tile.id.level - finest) << 12 | texel_level << 17);
}

Grid<glm::vec2> halved_pages(const Grid<glm::vec2>& fine) {
    Grid<glm::vec2> coarse(std::max(fine.cols() / 2, 1), std::max(fine.rows() / 2, 1));
    for (int row = 0; row < coarse.rows(); ++row) {
        for (int col = 0; col < coarse.cols(); ++col) {
            const glm::vec2 first = fine(2 * col, 2 * row);
            coarse(col, row) = {first.x, std::max({first.y, fine.clamped(2 * col + 1, 2 * row).y,
                                                   fine.clamped(2 * col, 2 * row + 1).y,
                                                   fine.clamped(2 * col + 1, 2 * row + 1).y})};
        }
    }
    return coarse;
}

// A tile's square of pages.
void set_pages(Grid<glm::vec2>& pages, glm::ivec2 count, terrain::TreeTile tile, int finest,
               glm::vec2 value) {
    const int side = 1 << (tile.level - finest);
    const glm::ivec2 first = glm::ivec2(tile.col, tile.row) * side;
    const glm::ivec2 end = glm::min(first + side, count);
    for (int row = first.y; row < end.y; ++row) {
        const auto line = pages.row(row);
        std::fill(line.begin() + first.x, line.begin() + end.x, value);
    }
}

Result<gl::Texture2D> upload_pages(Grid<glm::vec2> pages, view::FrameStats& stats) {
    auto texture = gl::Texture2D::create({.size = {pages.cols(), pages.rows()},
                                          .format = gl::Format::rg32f,
                                          .levels = gl::full_chain,
                                          .filter = gl::Filter::nearest});
    if (texture) {
        for (int level = 0; level < texture->levels(); ++level) {
            texture->upload(level, pages);
            pages = halved_pages(pages);
        }
        count_upload(stats, texture->bytes());
    }
    return texture;
}

Result<void> create_missing(std::optional<gl::TextureArray>& array,
                            const gl::TextureOptions& options, int layers) {
    if (array) {
        return {};
    }
    auto created = gl::TextureArray::create(options, layers);
    if (!created) {
        return created.error();
    }
    array = std::move(*created);
    return {};
}

template <class Texel>
Result<void> upload_layer(gl::TextureArray& array, int layer, const Grid<Texel>& texels,
                          gl::Format format, view::FrameStats& stats) {
    auto texture = upload_mipmapped(extended(texels, array.size().x), format, stats);
    if (!texture) {
        return texture.error();
    }
    array.copy(layer, *texture);
    return {};
}

Result<void> upload_lit(gl::TextureArray& array, int layer, const Image& lit,
                        view::FrameStats& stats) {
    return upload_layer(array, layer, lit, gl::Format::rgba8_srgb, stats);
}

} // namespace

Result<void> ReliefTiles::prepare(const view::DrawList& list, bool with_light, TileMaps& lights,
                                  view::FrameStats& stats) {
    ++frame_;
    for (const view::TerrainDraw* const draw : view::searched_terrains(list)) {
        if (draw->search->tiles.empty()) {
            continue;
        }
        if (auto done = prepare(list, *draw, with_light, lights, stats); !done) {
            return done;
        }
    }
    std::erase_if(streams_, [&](const auto& entry) {
        const Stream& stream = entry.second;
        return stream.owner.expired() || stream.drawn + kept_frames_of_stream < frame_;
    });
    return {};
}

Result<void> ReliefTiles::prepare(const view::DrawList& list, const view::TerrainDraw& draw,
                                  bool with_light, TileMaps& lights, view::FrameStats& stats) {
    const std::shared_ptr<scene::TileStream>& source = draw.terrain->stream;
    const scene::Technique& technique = draw.search->technique;
    Stream& stream = streams_[key_of(draw)];
    stream.owner = source;
    stream.drawn = frame_;
    const glm::dvec3 eye(glm::inverse(draw.world_from_local) * glm::dvec4(list.camera.eye, 1.0));
    stream.resident.space =
        streamed_space(source->maker(), draw.search->tiles, eye, draw.search->course);
    const std::vector<Drawn> tiles = placed(stream, draw);
    auto done = prepare_heights(stream, tiles, stats);
    done = done ? prepare_search(stream, tiles, technique, stats) : done;
    done = done ? prepare_pages(stream, tiles, stats) : done;
    if (done && with_light) {
        const auto light = view::light_on(list, draw.world_from_local);
        const Lit lit{light, light && technique.options.shadow};
        done = prepare_light(stream, tiles, source->maker(), lit,
                             light ? &lights.irradiance_of(source, *light) : nullptr, stats);
    }
    if (done && with_light && view::needs_ground(list, draw)) {
        done = prepare_ground(stream, tiles, source->maker(), stats);
    }
    return done;
}

// A layer for each tile that is no finer than the pages.
std::vector<ReliefTiles::Drawn> ReliefTiles::placed(Stream& stream,
                                                    const view::TerrainDraw& draw) const {
    std::vector<Drawn> drawn;
    for (const Tile& tile : draw.search->tiles) {
        if (tile->id.level >= stream.resident.space.level) {
            Slot& slot = stream.slots[tile->id];
            const bool is_new = slot.owner.lock() != tile;
            slot = is_new ? Slot{.owner = tile, .layer = slot.layer, .drawn = frame_} : slot;
            slot.drawn = frame_;
            drawn.push_back({tile, &slot});
        }
    }
    const auto needed = static_cast<int>(drawn.size());
    if (needed > stream.layers) {
        stream.layers = std::min(std::max(needed + needed / 4, min_layers), gl::max_layers);
        stream.resident = {.space = stream.resident.space};
        std::erase_if(stream.slots,
                      [&](const auto& entry) { return entry.second.drawn != frame_; });
        for (auto& [tile, slot] : stream.slots) {
            slot = Slot{.owner = slot.owner, .layer = no_layer, .drawn = frame_};
        }
    }
    place_new(stream);
    return drawn;
}

// Gives free layers to tiles without one; the longest undrawn tiles lose theirs.
void ReliefTiles::place_new(Stream& stream) const {
    std::vector<bool> is_taken(static_cast<std::size_t>(stream.layers));
    std::vector<std::pair<std::uint64_t, terrain::TreeTile>> undrawn;
    std::erase_if(stream.slots, [](const auto& entry) { return entry.second.owner.expired(); });
    for (const auto& [tile, slot] : stream.slots) {
        if (slot.layer != no_layer) {
            is_taken[static_cast<std::size_t>(slot.layer)] = true;
        }
        if (slot.drawn != frame_ && slot.layer != no_layer) {
            undrawn.emplace_back(slot.drawn, tile);
        }
    }
    std::sort(undrawn.begin(), undrawn.end());
    auto next_undrawn = undrawn.begin();
    auto free = is_taken.begin();
    for (auto& [tile, slot] : stream.slots) {
        if (slot.drawn != frame_ || slot.layer != no_layer) {
            continue;
        }
        free = std::find(free, is_taken.end(), false);
        if (free != is_taken.end()) {
            slot.layer = static_cast<int>(free - is_taken.begin());
            ++free;
        } else {
            Slot& oldest = stream.slots.at((next_undrawn++)->second);
            slot.layer = std::exchange(oldest.layer, no_layer);
            oldest.owner.reset();
        }
    }
}

Result<void> ReliefTiles::prepare_heights(Stream& stream, const std::vector<Drawn>& tiles,
                                          view::FrameStats& stats) {
    std::optional<gl::TextureArray>& array = stream.resident.heights;
    const gl::TextureOptions options{.size = glm::ivec2(vertices_a_side),
                                     .format = gl::Format::r32f};
    if (auto created = create_missing(array, options, stream.layers); !created) {
        return created;
    }
    for (const auto& [tile, slot] : tiles) {
        if (slot->has_heights) {
            ++stats.skipped.uploads_unchanged;
            continue;
        }
        array->upload(slot->layer, 0, extended(tile->heightfield.heights, vertices_a_side));
        count_upload(stats, array->bytes_per_layer());
        slot->has_heights = true;
    }
    return {};
}

Result<void> ReliefTiles::prepare_search(Stream& stream, const std::vector<Drawn>& tiles,
                                         const scene::Technique& technique,
                                         view::FrameStats& stats) {
    if (uses_max_mipmap(technique)) {
        if (auto done = prepare_max(stream, tiles, stats); !done) {
            return done;
        }
    }
    return technique.id() == scene::TechniqueId::cone ? prepare_cones(stream, tiles, stats)
                                                      : Result<void>();
}

Result<void> ReliefTiles::prepare_max(Stream& stream, const std::vector<Drawn>& tiles,
                                      view::FrameStats& stats) {
    std::optional<gl::TextureArray>& array = stream.resident.max_mipmaps;
    const gl::TextureOptions options{.size = glm::ivec2(page_cells),
                                     .format = gl::Format::r32f,
                                     .levels = gl::full_chain,
                                     .filter = gl::Filter::nearest};
    if (auto created = create_missing(array, options, stream.layers); !created) {
        return created;
    }
    for (const auto& [tile, slot] : tiles) {
        if (slot->has_max) {
            continue;
        }
        const Grid<float> heights = extended(tile->heightfield.heights, vertices_a_side);
        const std::vector<Grid<float>> levels = max_mipmap(heights.view());
        for (std::size_t level = 0; level < levels.size(); ++level) {
            array->upload(slot->layer, static_cast<int>(level), levels[level]);
        }
        count_upload(stats, array->bytes_per_layer());
        slot->has_max = true;
    }
    return {};
}

Result<void> ReliefTiles::prepare_cones(Stream& stream, const std::vector<Drawn>& tiles,
                                        view::FrameStats& stats) {
    std::optional<gl::TextureArray>& array = stream.resident.cones;
    const gl::TextureOptions options{
        .size = glm::ivec2(page_cells), .format = gl::Format::rg32f, .filter = gl::Filter::nearest};
    if (auto created = create_missing(array, options, stream.layers); !created) {
        return created;
    }
    for (const auto& [tile, slot] : tiles) {
        if (!slot->has_cones) {
            array->upload(slot->layer, 0, cones_of(*tile));
            count_upload(stats, array->bytes_per_layer());
            slot->has_cones = true;
        }
    }
    return {};
}

// The textures of the tiles' light, empty where tiles need others.
Result<void> ReliefTiles::prepare_light_arrays(Stream& stream, const std::vector<Drawn>& tiles,
                                               const Lit& lit) {
    ResidentReliefTiles& resident = stream.resident;
    int side = resident.lit ? resident.lit->size().x : 0;
    for (const Drawn& drawn : tiles) {
        side = std::max(side, page_cells * texels_a_cell(*drawn.tile) + 1);
    }
    if (resident.lit &&
        (resident.lit->size().x != side || resident.sun.has_value() != lit.in_parts)) {
        resident.lit.reset();
        resident.sun.reset();
        resident.albedo.reset();
        resident.normals.reset();
        for (auto& [tile, slot] : stream.slots) {
            slot.lit.reset();
            slot.has_ground = false;
        }
    }
    const gl::TextureOptions options{.size = glm::ivec2(side),
                                     .format = gl::Format::rgba8_srgb,
                                     .levels = gl::full_chain,
                                     .filter = gl::Filter::trilinear};
    auto done = create_missing(resident.lit, options, stream.layers);
    return done && lit.in_parts ? create_missing(resident.sun, options, stream.layers) : done;
}

Result<void> ReliefTiles::prepare_light(Stream& stream, const std::vector<Drawn>& tiles,
                                        const scene::TileBuilder& builder, const Lit& lit,
                                        const scene::TerrainIrradiance* irradiance,
                                        view::FrameStats& stats) {
    auto done = prepare_light_arrays(stream, tiles, lit);
    ResidentReliefTiles& resident = stream.resident;
    const auto upload = [&](const scene::TerrainTile& tile, int layer) {
        if (!lit.in_parts) {
            return upload_lit(*resident.lit, layer,
                              irradiance != nullptr ? scene::lit_tile(builder, tile, *irradiance)
                                                    : tile.albedo,
                              stats);
        }
        const scene::LitTileParts parts = scene::lit_tile_parts(builder, tile, *irradiance);
        auto sky = upload_lit(*resident.lit, layer, parts.sky, stats);
        return sky ? upload_lit(*resident.sun, layer, parts.sun, stats) : sky;
    };
    for (const auto& [tile, slot] : tiles) {
        if (done && slot->lit != lit) {
            done = upload(*tile, slot->layer);
            slot->lit = done ? std::optional(lit) : std::nullopt;
        }
    }
    return done;
}

// Precondition: the light is prepared.
Result<void> ReliefTiles::prepare_ground(Stream& stream, const std::vector<Drawn>& tiles,
                                         const scene::TileBuilder& builder,
                                         view::FrameStats& stats) {
    ResidentReliefTiles& resident = stream.resident;
    const int side = resident.lit->size().x;
    gl::TextureOptions options{.size = glm::ivec2(side),
                               .format = gl::Format::rgba8_srgb,
                               .levels = gl::full_chain,
                               .filter = gl::Filter::trilinear};
    auto done = create_missing(resident.albedo, options, stream.layers);
    options.format = gl::Format::rgba16_snorm;
    done = done ? create_missing(resident.normals, options, stream.layers) : done;
    for (const auto& [tile, slot] : tiles) {
        if (!done || slot->has_ground) {
            continue;
        }
        const view::GroundMap map = view::ground_of_tile(builder, *tile, nullptr);
        done = upload_lit(*resident.albedo, slot->layer, map.albedo, stats);
        done = done ? upload_layer(*resident.normals, slot->layer, snorm16(map.surface),
                                   options.format, stats)
                    : done;
        slot->has_ground = done.has_value();
    }
    return done;
}

Result<void> ReliefTiles::prepare_pages(Stream& stream, const std::vector<Drawn>& tiles,
                                        view::FrameStats& stats) {
    const int finest = stream.resident.space.level;
    const auto owner = stream.owner.lock();
    std::vector<std::pair<terrain::TreeTile, glm::vec2>> shown;
    shown.reserve(tiles.size());
    for (const auto& [tile, slot] : tiles) {
        shown.emplace_back(tile->id,
                           glm::vec2(packed_tile(*tile, slot->layer, finest), highest_of(*tile)));
    }
    if (stream.resident.pages && stream.shown == shown) {
        ++stats.skipped.uploads_unchanged;
        return {};
    }
    const glm::ivec2 count = terrain::level_tiles(owner->tree(), finest);
    const auto side_for = [](int pages) {
        return static_cast<int>(std::bit_ceil(static_cast<unsigned>(pages)));
    };
    Grid<glm::vec2> pages(side_for(count.x), side_for(count.y),
                          glm::vec2(0.0F, std::numeric_limits<float>::lowest()));
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        set_pages(pages, count, tiles[i].tile->id, finest, shown[i].second);
    }
    auto texture = upload_pages(std::move(pages), stats);
    if (!texture) {
        return texture.error();
    }
    stream.resident.pages = std::move(*texture);
    stream.shown = std::move(shown);
    return {};
}

const ResidentReliefTiles& ReliefTiles::tiles(const view::TerrainDraw& draw) const {
    return streams_.at(key_of(draw)).resident;
}

} // namespace reljef::render
