#include "engine/cast/frame/tile_contents.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <span>
#include <utility>

#include <glm/common.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include "engine/cast/frame/seen_terrain.h"
#include "engine/cast/frame/tile_pieces.h"
#include "engine/core/parallel_for.h"
#include "engine/scene/streaming/tile_stream.h"

namespace reljef::cast {
namespace {

// Frames that unused content stays.
constexpr std::uint64_t kept_frames = 8;

bool has_near_detail(const view::TileDraw& draw) {
    return draw.detail != view::DetailLevel::none;
}

std::size_t number_of(const TilePiece& piece) {
    constexpr auto in_row = static_cast<std::size_t>(max_tile_parts.x);
    return static_cast<std::size_t>(piece.part.y) * in_row + static_cast<std::size_t>(piece.part.x);
}

// A rectangle of pixels around all that is seen of a box in samples of the overview.
class SeenPixels {
public:
    SeenPixels(const view::DrawList& list, const terrain::Placement& overview,
               const glm::dmat4& world_from_local)
        : size_(list.size), overview_(overview),
          clip_from_local_(scene::clip_from_world(list.camera, list.size) * world_from_local) {}

    [[nodiscard]] PixelBlock of(const Box& samples) const {
        std::array<glm::dvec3, 8> corners = corners_of(samples);
        for (glm::dvec3& corner : corners) {
            corner = overview_.world_from_sample(corner);
        }
        return seen_pixels(clip_from_local_, size_, corners);
    }
    [[nodiscard]] PixelBlock of_local(const Box& local) const {
        return seen_pixels(clip_from_local_, size_, corners_of(local));
    }

private:
    glm::ivec2 size_;
    const terrain::Placement& overview_;
    glm::dmat4 clip_from_local_;
};

} // namespace

void TileContents::forget_unused() {
    ++frame_;
    std::erase_if(contents_, [&](const auto& entry) {
        return entry.second.owner.expired() || entry.second.drawn + kept_frames < frame_;
    });
}

void TileContents::add_light(const view::PreparedLight& prepared) {
    light_ = {prepared.request.stream, prepared.request.light, prepared.irradiance};
}

const scene::TerrainIrradiance& TileContents::irradiance_of(const scene::TerrainNode& terrain,
                                                            const scene::TerrainLight& light) {
    if (light_.owner.lock() != terrain.stream || light_.light != light ||
        light_.irradiance == nullptr) {
        light_ = {terrain.stream, light,
                  std::make_shared<const scene::TerrainIrradiance>(
                      terrain.stream->maker().overview(), light)};
    }
    return *light_.irradiance;
}

TileContents::Content&
TileContents::content_of(const std::shared_ptr<const scene::TerrainTile>& tile) {
    Content& content = contents_[tile.get()];
    if (content.owner.lock() != tile) {
        content = {};
        content.owner = tile;
    }
    content.drawn = frame_;
    return content;
}

std::vector<TileContents::Missing>
TileContents::find_missing(const view::DrawList& list,
                           const std::optional<scene::TerrainLight>& light, const Options& options,
                           view::FrameStats& stats) {
    std::vector<Missing> missing;
    for (const view::TileDraw& draw : list.tiles) {
        Content& content = content_of(draw.tile);
        const bool has_paint =
            !options.paints || (content.levels && content.light == light &&
                                content.sun.has_value() == (options.in_parts && light));
        if (content.ground && content.light != light) {
            content.ground->sun_share.reset();
        }
        const bool has_detail = has_near_detail(draw);
        const bool lacks_share = has_detail && light && !options.in_parts && content.ground &&
                                 !content.ground->sun_share;
        const bool needs_ground = options.paints && (!content.ground || lacks_share) &&
                                  (has_detail || view::needs_ground(list, draw));
        if (content.pieces.front() && has_paint && !needs_ground) {
            ++stats.skipped.uploads_unchanged;
        } else {
            missing.push_back({draw.tile.get(), &content, needs_ground});
        }
    }
    return missing;
}

void TileContents::make_levels(const scene::TileBuilder& builder,
                               const scene::TerrainIrradiance* irradiance, bool in_parts,
                               const Missing& missing) {
    const scene::TerrainTile& tile = *missing.tile;
    const glm::ivec2 samples = tile.cells + 1;
    constexpr unsigned alone = 1; // other threads make other tiles
    missing.content->sun.reset();
    if (irradiance == nullptr) {
        missing.content->levels.emplace(tile.albedo, samples, alone);
    } else if (in_parts) {
        const scene::LitTileParts parts = scene::lit_tile_parts(builder, tile, *irradiance, alone);
        missing.content->levels.emplace(parts.sky, samples, alone);
        missing.content->sun.emplace(parts.sun, samples, alone);
    } else {
        missing.content->levels.emplace(scene::lit_tile(builder, tile, *irradiance, alone), samples,
                                        alone);
    }
}

void TileContents::make_pieces(const scene::TileBuilder& builder, const Missing& missing) {
    const GridView<const float> heights = missing.tile->heightfield.heights.view();
    for (const TilePiece& piece :
         pieces_of(builder.lattice(missing.tile->id), glm::dvec2(0.0), glm::dvec2(0.0))) {
        missing.content->pieces[number_of(piece)].emplace(
            heights.window(piece.vertex.x, piece.vertex.y, piece.cells.x + 1, piece.cells.y + 1));
    }
}

std::size_t TileContents::bytes_of(const Content& content) {
    std::size_t bytes = content.levels ? content.levels->bytes() : 0;
    bytes += content.sun ? content.sun->bytes() : 0;
    bytes += content.ground ? content.ground->bytes() : 0;
    for (const std::optional<RayTile>& piece : content.pieces) {
        bytes += piece ? piece->bytes() : 0;
    }
    return bytes;
}

void TileContents::make(const view::DrawList& list, const Options& options,
                        view::FrameStats& stats) {
    const scene::TerrainNode& terrain = *list.tiles.front().terrain;
    const auto light = view::light_on(list, list.world_from_local(list.tiles.front()));
    const std::vector<Missing> missing = find_missing(list, light, options, stats);
    if (missing.empty()) {
        return;
    }
    const scene::TileBuilder& builder = terrain.stream->maker();
    const scene::TerrainIrradiance* const irradiance =
        light && options.paints ? &irradiance_of(terrain, *light) : nullptr;
    const auto make_one = [&](int index) {
        const Missing& one = missing[static_cast<std::size_t>(index)];
        if (!one.content->pieces.front()) {
            make_pieces(builder, one);
        }
        if (options.paints) {
            make_levels(builder, irradiance, options.in_parts, one);
            one.content->light = light;
        }
        if (one.needs_ground) {
            const bool needs_share = view::has_detail(terrain) && !options.in_parts;
            one.content->ground =
                lit_ground(builder, *one.tile, needs_share ? irradiance : nullptr);
        }
    };
    ParallelOptions parallel;
    parallel.threads = options.threads;
    parallel_for(static_cast<int>(missing.size()), make_one, parallel);
    stats.uploads += static_cast<int>(missing.size());
    for (const Missing& made : missing) {
        stats.upload_bytes += bytes_of(*made.content);
    }
}

namespace {

// Places the pieces of tiles.
class Placer {
public:
    /// `lowest`: of all heights, true metres.
    Placer(const view::DrawList& list, const PictureRays& rays,
           const TileContents::Options& options, float lowest)
        : list_(list), rays_(rays), options_(options), draw_(list.tiles.front()),
          builder_(draw_.terrain->stream->maker()),
          scale_(builder_.from_overview(glm::dvec2(2.0)) - builder_.from_overview(glm::dvec2(1.0))),
          zero_(builder_.from_overview(glm::dvec2(1.0)) - scale_),
          last_(builder_.sample(builder_.tree().root(),
                                builder_.tree().cells(builder_.tree().root()))),
          metres_(draw_.terrain->surface->placement().spacing() / scale_),
          seen_(list, draw_.terrain->surface->placement(), list.world_from_local(draw_)),
          rows_(rows_of(*draw_.terrain)), lowest_(lowest), is_outside_(is_outside()),
          seam_(options.is_curved && builder_.tree().wraps_longitude() ? west_wall | east_wall
                                                                       : 0U) {}

    [[nodiscard]] std::vector<TilePiece> pieces(const view::TileDraw& draw) const {
        return pieces_of(builder_.lattice(draw.tile->id), last_, from());
    }
    // Where all rays begin, samples of the terrain; infinite along the axes of parallel ones.
    [[nodiscard]] glm::dvec2 from() const {
        if (options_.is_curved) {
            return glm::dvec2(0.0); // there is no such place
        }
        if (list_.camera.projection == scene::ProjectionKind::perspective) {
            return zero_ + scale_ * glm::dvec2(rays_.origin.first);
        }
        const glm::dvec2 direction(rays_.direction.first);
        const double far = std::numeric_limits<double>::infinity();
        return {direction.x > 0.0 ? -far : far, direction.y > 0.0 ? -far : far};
    }

    // Without its paint.
    [[nodiscard]] PlacedTile placed(const view::TileDraw& draw, const TilePiece& piece,
                                    const RayTile& samples) const {
        PlacedTile tile;
        tile.tile = &samples;
        tile.scale = scale_ / piece.step;
        tile.by = (zero_ - piece.first) / piece.step;
        tile.rays = options_.is_curved ? rays_ : in_samples(rays_, tile.scale, tile.by);
        tile.walls = piece.walls | seam_;
        tile.first = piece.first;
        tile.step = piece.step;
        tile.seen = options_.is_curved ? seen_.of_local(local_box(draw, piece, samples.total()))
                                       : seen_.of(box(piece, samples.total()));
        return tile;
    }

    [[nodiscard]] glm::vec2 longest(const TilePaint& paint, const TilePiece& piece) const {
        return longest_texels(list_, paint, metres_ * piece.step);
    }

    // In samples of the overview. With all rays that come in from outside, below the surface: they
    // must be known to be below it, or hit the walls of the next tiles.
    [[nodiscard]] Box box(const TilePiece& piece, terrain::MinMax total) const {
        const glm::dvec2 end = piece.first + piece.step * glm::dvec2(piece.cells);
        Box box;
        box.add(glm::dvec3((piece.first - zero_) / scale_,
                           lets_in(piece) ? std::min(lowest_, total.low) : total.low));
        box.add(glm::dvec3((end - zero_) / scale_, total.high));
        return box;
    }
    // In samples of the overview, which lies inside of the terrain.
    [[nodiscard]] glm::dvec2 first_of(terrain::TreeTile tile) const {
        return (builder_.first(tile) - zero_) / scale_;
    }

private:
    [[nodiscard]] bool is_outside() const {
        if (list_.camera.projection == scene::ProjectionKind::orthographic) {
            return true;
        }
        const glm::dvec3 eye(glm::inverse(list_.world_from_local(draw_)) *
                             glm::dvec4(list_.camera.eye, 1.0));
        const auto overview = draw_.terrain->surface->placement().sample_from_world(eye);
        if (!overview) {
            return true;
        }
        const glm::dvec2 sample = zero_ + scale_ * glm::dvec2(*overview);
        return glm::clamp(sample, glm::dvec2(0.0), last_) != sample;
    }
    [[nodiscard]] bool lets_in(const TilePiece& piece) const {
        return is_outside_ && piece.walls != (west_wall | east_wall | north_wall | south_wall);
    }
    // In local metres.
    [[nodiscard]] Box local_box(const view::TileDraw& draw, const TilePiece& piece,
                                terrain::MinMax total) const {
        Box local = draw.tile->bounds;
        if (lets_in(piece)) {
            for (const glm::dvec3& corner : corners_of(box(piece, total))) {
                local.add(draw_.terrain->surface->placement().world_from_sample(
                    {corner.x, rows_.from_even_row(corner.y), corner.z}));
            }
        }
        return local;
    }

    const view::DrawList& list_;
    const PictureRays& rays_;
    const TileContents::Options& options_;
    const view::TileDraw& draw_;
    const scene::TileBuilder& builder_;
    glm::dvec2 scale_;  // samples of the terrain in one of the overview
    glm::dvec2 zero_;   // sample of the terrain at the overview's first, both with even rows
    glm::dvec2 last_;   // sample of the terrain
    glm::dvec2 metres_; // of a sample of the terrain
    SeenPixels seen_;
    geo::WrappedRows rows_; // of the overview, if it is on the ellipsoid
    float lowest_;
    bool is_outside_;
    unsigned seam_; // walls of a globe, at the other end of which rays go on
};

int add_pieces(std::span<const TilePiece> pieces, const Placer& placer,
               const std::vector<PlacedTile>& tiles, std::size_t first, TileNodes& nodes) {
    std::vector<TileNode> boxes;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const PlacedTile& tile = tiles[first + i];
        TileNode& node = boxes.emplace_back();
        node.box = placer.box(pieces[i], tile.tile->total());
        node.seen = tile.seen;
        node.tile = static_cast<int>(first + i);
    }
    return add_piece_nodes(pieces, boxes, nodes);
}

} // namespace

float TileContents::lowest_of(const view::DrawList& list) const {
    float lowest = std::numeric_limits<float>::infinity();
    for (const view::TileDraw& draw : list.tiles) {
        for (const std::optional<RayTile>& piece : contents_.at(draw.tile.get()).pieces) {
            lowest = piece ? std::min(lowest, piece->total().low) : lowest;
        }
    }
    return lowest;
}

void TileContents::paint(const Content& content, glm::vec2 vertex, bool needs_ground,
                         PlacedTile& tile) {
    tile.paint = content.levels->paint(vertex);
    if (content.ground && needs_ground) {
        content.ground->paint(tile, vertex);
    }
    if (content.sun) {
        tile.sun = content.sun->paint(vertex);
    }
}

PlacedTiles TileContents::place(const view::DrawList& list, const PictureRays& rays,
                                const Options& options, view::FrameStats& stats) {
    forget_unused();
    make(list, options, stats);
    const float lowest = lowest_of(list);
    const Placer placer(list, rays, options, lowest);
    const scene::TileBuilder& builder = list.tiles.front().terrain->stream->maker();
    std::vector<terrain::TreeTile> ids;
    for (const view::TileDraw& draw : list.tiles) {
        ids.push_back(draw.tile->id);
    }
    PlacedTiles placed;
    placed.has_walls = true;
    placed.wall_floor = lowest;
    placed.rows = builder.rows();
    const auto add = [&](std::size_t index) {
        const view::TileDraw& draw = list.tiles[index];
        const Content& content = contents_.at(draw.tile.get());
        std::vector<TilePiece> pieces = placer.pieces(draw);
        for (const TilePiece& piece : pieces) {
            PlacedTile& tile = placed.tiles.emplace_back(
                placer.placed(draw, piece, *content.pieces[number_of(piece)]));
            if (options.paints) {
                const bool needs_ground = has_near_detail(draw) || view::needs_ground(list, draw);
                paint(content, glm::vec2(piece.vertex), needs_ground, tile);
                tile.paint.longest_texels = placer.longest(tile.paint, piece);
            }
        }
        return pieces;
    };
    if (!options.is_curved) {
        for (const std::size_t index :
             front_to_back(builder.tree(), ids, builder.tree_sample(placer.from()))) {
            add(index);
        }
        return placed;
    }
    placed.nodes = nodes_of(
        builder.tree(), ids, [&](terrain::TreeTile tile) { return placer.first_of(tile); },
        [&](std::size_t index, TileNodes& nodes) {
            const std::size_t first = placed.tiles.size();
            const std::vector<TilePiece> pieces = add(index);
            return add_pieces(pieces, placer, placed.tiles, first, nodes);
        });
    return placed;
}

namespace {

// The cells of a tile that a child covers.
struct Quarter {
    glm::ivec2 first{0};
    glm::ivec2 cells{0};
};

// Without a shorter last cell.
Quarter quarter_of(const terrain::TileLattice& lattice, terrain::TreeTile child) {
    constexpr int half = terrain::tree_tile_cells / 2;
    const glm::ivec2 first = half * glm::ivec2(child.col % 2, child.row % 2);
    const glm::ivec2 end = glm::min(first + half, glm::min(lattice.cells, lattice.shorter_from()));
    return {first, end - first};
}

} // namespace

std::vector<SunSource> TileContents::beside(const scene::TileBuilder& builder,
                                            std::span<const SharedTile> drawn,
                                            std::span<const SharedTile> above) {
    std::set<terrain::TreeTile> loaded;
    for (const auto& tiles : {drawn, above}) {
        for (const SharedTile& tile : tiles) {
            loaded.insert(tile->id);
        }
    }
    std::vector<SunSource> sources;
    for (const SharedTile& tile : above) {
        const terrain::TileLattice lattice = builder.lattice(tile->id);
        for (const terrain::TreeTile child : builder.tree().children(tile->id)) {
            const Quarter quarter = quarter_of(lattice, child);
            if (loaded.contains(child) || quarter.cells.x < 1 || quarter.cells.y < 1) {
                continue;
            }
            auto& samples =
                content_of(tile)
                    .quarters[static_cast<std::size_t>(child.col % 2 + child.row % 2 * 2)];
            if (!samples) {
                samples.emplace(tile->heightfield.heights.view().window(
                    quarter.first.x, quarter.first.y, quarter.cells.x + 1, quarter.cells.y + 1));
            }
            sources.push_back({&*samples, lattice.first + lattice.step * glm::dvec2(quarter.first),
                               glm::dvec2(lattice.step)});
        }
    }
    return sources;
}

} // namespace reljef::cast
