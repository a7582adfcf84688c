#include "engine/cast/tile_contents.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/common.hpp>
#include <glm/vec4.hpp>

#include "engine/cast/tile_pieces.h"
#include "engine/core/parallel_for.h"
#include "engine/scene/tile_stream.h"

namespace reljef::cast {
namespace {

// Frames that unused content stays.
constexpr std::uint64_t kept_frames = 8;

std::size_t number_of(const TilePiece& piece) {
    return (piece.vertex.x > 0 ? 1U : 0U) + (piece.vertex.y > 0 ? 2U : 0U);
}

// Where all rays begin; infinite along the axes of parallel ones.
glm::dvec2 beginning_of(const view::DrawList& list, const PictureRays& rays) {
    if (list.camera.projection == scene::ProjectionKind::perspective) {
        return glm::dvec2(rays.origin.first);
    }
    const glm::dvec2 direction(rays.direction.first);
    const double far = std::numeric_limits<double>::infinity();
    return {direction.x > 0.0 ? -far : far, direction.y > 0.0 ? -far : far};
}

// A rectangle of pixels around all that is seen of a box in samples of the overview.
class SeenPixels {
public:
    SeenPixels(const view::DrawList& list, const terrain::Placement& overview,
               const glm::dmat4& world_from_local)
        : size_(list.size), overview_(overview),
          clip_from_local_(scene::clip_from_world(list.camera, list.size) * world_from_local) {}

    [[nodiscard]] PixelBlock of(const Box& samples) const {
        glm::dvec2 low(std::numeric_limits<double>::infinity());
        glm::dvec2 high = -low;
        for (int i = 0; i < 8; ++i) {
            const glm::dvec3 corner((i & 1) != 0 ? samples.high.x : samples.low.x,
                                    (i & 2) != 0 ? samples.high.y : samples.low.y,
                                    (i & 4) != 0 ? samples.high.z : samples.low.z);
            const glm::dvec4 clip =
                clip_from_local_ * glm::dvec4(overview_.world_from_sample(corner), 1.0);
            if (!(clip.w > 0.0)) {
                return {{0, 0}, size_}; // reaches behind the eye
            }
            const glm::dvec2 pixel =
                (0.5 + glm::dvec2(0.5, -0.5) * glm::dvec2(clip) / clip.w) * glm::dvec2(size_);
            low = glm::min(low, pixel);
            high = glm::max(high, pixel);
        }
        constexpr double margin = 1.0; // floats of rays are off by far less
        const glm::dvec2 end(size_);
        const glm::ivec2 first(glm::floor(glm::clamp(low - margin, glm::dvec2(0.0), end)));
        const glm::ivec2 last(glm::ceil(glm::clamp(high + margin, glm::dvec2(0.0), end)));
        return {first, last - first};
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

std::vector<TileContents::Missing>
TileContents::find_missing(const view::DrawList& list,
                           const std::optional<scene::TerrainLight>& light, bool paints,
                           view::FrameStats& stats) {
    std::vector<Missing> missing;
    for (const view::TileDraw& draw : list.tiles) {
        Content& content = contents_[draw.tile.get()];
        if (content.owner.lock() != draw.tile) {
            content = {};
            content.owner = draw.tile;
        }
        content.drawn = frame_;
        const bool has_paint = !paints || (content.levels && content.light == light);
        if (content.pieces.front() && has_paint) {
            ++stats.skipped.uploads_unchanged;
        } else {
            missing.push_back({draw.tile.get(), &content});
        }
    }
    return missing;
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
    for (const std::optional<RayTile>& piece : content.pieces) {
        bytes += piece ? piece->bytes() : 0;
    }
    return bytes;
}

void TileContents::make(const view::DrawList& list, const Options& options,
                        view::FrameStats& stats) {
    const scene::TerrainNode& terrain = *list.tiles.front().terrain;
    const auto light = view::light_on(list, list.world_from_local(list.tiles.front()));
    const std::vector<Missing> missing = find_missing(list, light, options.paints, stats);
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
            one.content->levels.emplace(irradiance != nullptr
                                            ? scene::lit_tile(builder, *one.tile, *irradiance, 1)
                                            : one.tile->albedo,
                                        one.tile->cells + 1);
            one.content->light = light;
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

PlacedTiles TileContents::place(const view::DrawList& list, const PictureRays& rays,
                                const Options& options, view::FrameStats& stats) {
    forget_unused();
    make(list, options, stats);
    const view::TileDraw& any = list.tiles.front();
    const scene::TileBuilder& builder = any.terrain->stream->maker();
    const terrain::Placement& overview = any.terrain->surface->placement();
    const glm::dvec2 zero = builder.from_overview(glm::dvec2(0.0));
    const PictureRays on_terrain =
        in_samples(rays, builder.from_overview(glm::dvec2(1.0)) - zero, zero);
    const glm::dvec2 from = beginning_of(list, on_terrain);
    const terrain::TileTree& tree = builder.tree();
    const glm::dvec2 last = builder.sample(tree.root(), tree.cells(tree.root()));
    const glm::dvec2 metres = overview.spacing() * (builder.on_overview(glm::dvec2(1.0)) -
                                                    builder.on_overview(glm::dvec2(0.0)));
    const SeenPixels seen(list, overview, list.world_from_local(any));
    std::vector<terrain::TreeTile> ids;
    for (const view::TileDraw& draw : list.tiles) {
        ids.push_back(draw.tile->id);
    }
    PlacedTiles placed;
    placed.has_walls = true;
    for (const std::size_t index : front_to_back(tree, ids, builder.tree_sample(from))) {
        const Content& content = contents_.at(list.tiles[index].tile.get());
        for (const TilePiece& piece : pieces_of(builder.lattice(ids[index]), last, from)) {
            PlacedTile& tile = placed.tiles.emplace_back();
            tile.tile = &*content.pieces[number_of(piece)];
            tile.rays = in_samples(on_terrain, 1.0 / piece.step, -piece.first / piece.step);
            tile.walls = piece.walls;
            tile.first = piece.first;
            tile.step = piece.step;
            Box box;
            box.add(glm::dvec3(builder.on_overview(piece.first), tile.tile->total().low));
            box.add(
                glm::dvec3(builder.on_overview(piece.first + piece.step * glm::dvec2(piece.cells)),
                           tile.tile->total().high));
            tile.seen = seen.of(box);
            if (options.paints) {
                tile.paint = content.levels->paint(glm::vec2(piece.vertex));
                tile.paint.longest_texels = longest_texels(list, tile.paint, metres * piece.step);
            }
        }
    }
    return placed;
}

} // namespace reljef::cast
