#include "engine/cast/frame/driver.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/matrix.hpp>

#include "engine/cast/block_rays.h"
#include "engine/cast/cast_hits.h"
#include "engine/cast/frame/earth_rays.h"
#include "engine/cast/frame/sun_light.h"
#include "engine/core/stopwatch.h"
#include "engine/scene/streaming/certain_sun.h"
#include "engine/scene/streaming/tile_stream.h"

namespace reljef::cast {
namespace {

// The finest tiles that are searched as tiles, and the others, above them.
StreamedList with_searched_tiles(view::DrawList list) {
    StreamedList made;
    for (std::size_t i = 0; i < list.terrains.size(); ++i) {
        const view::TerrainDraw& terrain = list.terrains[i];
        if (!terrain.search || terrain.search->tiles.empty()) {
            continue;
        }
        const view::SurfaceSearch search = *std::exchange(list.terrains[i].search, {});
        std::set<terrain::TreeTile> above;
        for (const auto& tile : search.tiles) {
            terrain::TreeTile id = tile->id;
            const int top = search.tiles.front()->id.level;
            while (id.level < top) {
                id = {id.level + 1, id.col / 2, id.row / 2};
                above.insert(id);
            }
        }
        for (const auto& tile : search.tiles) {
            if (above.contains(tile->id)) {
                made.above.push_back(tile);
                continue;
            }
            view::TileDraw& draw = list.tiles.emplace_back();
            draw.terrain = terrain.terrain;
            draw.tile = tile;
            draw.node = i;
            draw.error = search.tile_error.value_or(0.0);
        }
    }
    made.list = std::move(list);
    if (made.above.empty()) {
        made.above = tiles_above(made.list);
    }
    return made;
}

// Tiles are drawn in pieces, also the one of a terrain in memory.
int tile_count(const view::DrawList& list, const PlacedTiles& placed) {
    return list.tiles.empty() && !placed.tiles.empty() ? 1 : static_cast<int>(list.tiles.size());
}

// Those of the picture's middles, unless they can only meet the sky.
std::size_t ray_count(const view::DrawList& list, const PlacedTiles& placed) {
    return placed.tiles.empty() && list.meshes.empty()
               ? 0
               : static_cast<std::size_t>(list.size.x) * static_cast<std::size_t>(list.size.y);
}

} // namespace

Driver::Driver(const DriverOptions& options) : options_(options) {}

Result<Driver> Driver::create(const DriverOptions& options) {
    if (auto possible = view::check_samples(options.samples); !possible) {
        return possible.error();
    }
    Driver driver(options);
    auto sized = driver.resize(options.size);
    return sized ? Result<Driver>(std::move(driver)) : sized.error();
}

Result<void> Driver::resize(glm::ivec2 size) {
    constexpr int max_side = 1 << 14;
    if (size.x < 1 || size.y < 1 || size.x > max_side || size.y > max_side) {
        return Error{fmt::format("picture of {}x{} pixels: from 1x1 to {}x{} were expected", size.x,
                                 size.y, max_side, max_side)};
    }
    first_.resize(size);
    return {};
}

Driver::Surface& Driver::surface_of(const std::shared_ptr<const scene::TerrainSurface>& surface) {
    std::erase_if(surfaces_, [](const auto& entry) { return entry.second.owner.expired(); });
    Surface& found = surfaces_[surface.get()];
    found.owner = surface;
    return found;
}

// Of a terrain in memory.
void Driver::place_surface(const SeenTerrain& seen, const PictureRays& rays, PlacedTiles& placed,
                           view::FrameStats& stats) {
    const scene::TerrainNode& terrain = *seen.node;
    Surface& surface = surface_of(terrain.surface);
    const auto heights = terrain.surface->heightfield().heights.view();
    const std::vector<TilePiece> pieces = surface_pieces(terrain);
    if (surface.tiles.size() == pieces.size()) {
        ++stats.skipped.uploads_unchanged;
    } else {
        surface.tiles.clear();
        for (const TilePiece& piece : pieces) {
            surface.tiles.push_back(std::make_shared<const RayTile>(heights.window(
                piece.vertex.x, piece.vertex.y, piece.cells.x + 1, piece.cells.y + 1)));
            stats.upload_bytes += surface.tiles.back()->bytes();
        }
        ++stats.uploads;
    }
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        PlacedTile& tile = placed.tiles.emplace_back();
        tile.tile = surface.tiles[i].get();
        tile.rays = rays;
        tile.seen = {{0, 0}, rays.size};
        tile.walls = pieces[i].walls;
        tile.first = pieces[i].first;
        tile.step = pieces[i].step;
        tile.scale = 1.0 / tile.step;
        tile.by = -tile.first / tile.step;
    }
    placed.rows = rows_of(terrain);
    join_ends(seen, pieces, placed);
}

namespace {

std::shared_ptr<const LitLevels> levels_over(const scene::TerrainSurface& surface,
                                             const Image& lit) {
    const Grid<float>& heights = surface.heightfield().heights;
    return std::make_shared<const LitLevels>(lit, glm::ivec2(heights.cols(), heights.rows()));
}

} // namespace

const Driver::Light& Driver::light_of(const scene::TerrainNode& terrain,
                                      const std::optional<scene::TerrainLight>& light,
                                      view::FrameStats& stats) {
    Light& made = surface_of(terrain.surface).light;
    const bool in_parts = light && terrain.material.technique.options.shadow;
    if (made.levels != nullptr && made.light == light && in_parts == (made.sun != nullptr)) {
        ++stats.skipped.uploads_unchanged;
        return made;
    }
    made = {light, nullptr, nullptr, {}};
    const scene::TerrainSurface& surface = *terrain.surface;
    if (in_parts) {
        const view::LightParts parts = view::light_parts(surface, *light, max_texture_side());
        made.levels = levels_over(surface, parts.sky);
        made.sun = levels_over(surface, parts.sun);
        stats.upload_bytes += made.sun->bytes();
    } else {
        made.levels = levels_over(surface, view::lit_map(surface, light, max_texture_side()));
    }
    ++stats.uploads;
    stats.upload_bytes += made.levels->bytes();
    return made;
}

Result<void> Driver::add_light(const view::PreparedLight& prepared) {
    const view::LightRequest& request = prepared.request;
    if (request.stream != nullptr) {
        if (!request.in_parts) {
            streamed_.add_light(prepared);
        }
        return {};
    }
    const scene::TerrainSurface& surface = *request.surface;
    surface_of(request.surface).light = {request.light,
                                         levels_over(surface, prepared.lit),
                                         request.in_parts ? levels_over(surface, prepared.sun)
                                                          : nullptr,
                                         {}};
    return {};
}

void Driver::forget_content() {
    surfaces_.clear();
    streamed_ = {};
    detail_ = {};
    mesh_trees_ = {};
    mesh_pictures_ = {};
}

namespace {

struct RaysOver {
    PictureRays straight; // in samples; over the ellipsoid only their range and anchor
    std::shared_ptr<const CurvedRays> curve;
};

RaysOver rays_over(const view::DrawList& list, const SeenTerrain& seen,
                   const DriverOptions& options, bool paints) {
    const terrain::Placement& placement = seen.node->surface->placement();
    if (!is_curved(*seen.node)) {
        return {
            picture_rays(list.camera, list.size, seen.world_from_local, placement, seen.samples),
            nullptr};
    }
    auto curve = earth_rays(list, seen, {options.threads, !paints || options.samples == 1});
    PictureRays straight;
    straight.size = list.size;
    straight.range = curve->local().range;
    straight.anchor = curve->local().anchor;
    return {straight, std::move(curve)};
}

std::vector<TileContents::SharedTile> tiles_of(const view::DrawList& list) {
    std::vector<TileContents::SharedTile> tiles;
    for (const view::TileDraw& draw : list.tiles) {
        tiles.push_back(draw.tile);
    }
    return tiles;
}

} // namespace

// Precondition: check_support().
PlacedTiles Driver::placed_tiles(const StreamedList& frame, bool paints, view::FrameStats& stats) {
    const view::DrawList& list = frame.list;
    const std::vector<SeenTerrain> terrains = seen_terrains(list);
    if (terrains.empty()) {
        return {};
    }
    const SeenTerrain& seen = terrains.front();
    const scene::TerrainNode& node = *seen.node;
    const auto [rays, curve] = rays_over(list, seen, options_, paints);
    const bool stands_in = node.stream != nullptr && !seen.has_tiles; // for tiles to be loaded
    if (!stands_in && (seen.has_tiles || node.surface->has_all_samples())) {
        const view::PictureRounding::Found rounding = rounding_of(list, seen);
        const double stretch = max_stretch(glm::dmat3(seen.world_from_local));
        const double of_rays = rounding.error + (curve != nullptr ? stretch * curve->error() : 0.0);
        stats.kept_error = kept_error(list, of_rays);
        stats.exceeded_by_rounding =
            rounding.is_of_view && 2.0 * of_rays > stats.kept_error.value_or(0.0);
    }
    if (seen.has_tiles) {
        const bool in_parts = node.material.technique.options.shadow.has_value();
        PlacedTiles placed = streamed_.place(
            list, rays, {options_.threads, paints, curve != nullptr, in_parts}, stats);
        placed.curve = curve;
        join_ends(seen, {}, placed);
        if (paints && in_parts) {
            add_sun(list, seen, streamed_.beside(node.stream->maker(), tiles_of(list), frame.above),
                    placed);
        }
        return placed;
    }
    PlacedTiles placed;
    placed.curve = curve;
    placed.has_walls = curve != nullptr;
    place_surface(seen, rays, placed, stats);
    if (paints) {
        paint_surface(list, seen, placed, stats);
        if (node.material.technique.options.shadow) {
            add_sun(list, seen, {}, placed);
            add_certain_sun(list, seen, placed.tiles.front());
        }
    }
    return placed;
}

// Of all rays at a terrain, pixels.
view::PictureRounding::Found Driver::rounding_of(const view::DrawList& list,
                                                 const SeenTerrain& seen) {
    const view::TerrainDraw draw{.terrain = seen.node, .world_from_local = seen.world_from_local};
    return rounding_.of(list, draw, seen.has_tiles ? tiles_of(list) : seen.node->surface->tiles(),
                        view::RayFloats::cpu);
}

// Of a terrain in memory.
void Driver::add_certain_sun(const view::DrawList& list, const SeenTerrain& seen,
                             PlacedTile& tile) {
    const auto rays = options_.skips.certain ? certain_sun_rays(list, seen, tile)
                                             : std::optional<scene::SunRays>();
    if (!rays) {
        return;
    }
    Light& light = surface_of(seen.node->surface).light;
    if (light.certain_sun.empty()) {
        light.certain_sun = packed_certain_sun(*seen.node->surface, *rays);
    }
    tile.certain_sun = light.certain_sun;
    tile.certain_stride = certain_stride(tile.tile->cells().x);
}

// A terrain in memory.
void Driver::paint_surface(const view::DrawList& list, const SeenTerrain& seen, PlacedTiles& placed,
                           view::FrameStats& stats) {
    const auto on = view::light_on(list, seen.world_from_local);
    const terrain::Placement& placement = seen.node->surface->placement();
    const Light& light = light_of(*seen.node, on, stats);
    const bool has_detail = shows_detail(list, *seen.node);
    const LitGround* ground = nullptr;
    if (has_detail || (!list.point_lights.empty() &&
                       view::is_reached(list, transformed(seen.world_from_local, seen.local)))) {
        const bool needs_share = has_detail && light.sun == nullptr;
        ground = &ground_of(*seen.node, needs_share ? on : std::nullopt, stats);
    }
    for (PlacedTile& tile : placed.tiles) {
        const glm::vec2 first(0.0F, placed.rows.from_even_row(tile.first.y));
        tile.paint = light.levels->paint(first);
        tile.paint.longest_texels = longest_texels(list, tile.paint, placement.spacing());
        if (light.sun != nullptr) {
            tile.sun = light.sun->paint(first);
        }
        if (ground != nullptr) {
            ground->paint(tile, first);
        }
    }
}

// `light`: absent: without the share of the sun that is visible.
const LitGround& Driver::ground_of(const scene::TerrainNode& terrain,
                                   const std::optional<scene::TerrainLight>& light,
                                   view::FrameStats& stats) {
    Surface& surface = surface_of(terrain.surface);
    if (surface.ground == nullptr || surface.ground_light != light) {
        surface.ground = std::make_shared<const LitGround>(
            lit_ground(*terrain.surface, light, max_texture_side()));
        surface.ground_light = light;
        ++stats.uploads;
        stats.upload_bytes += surface.ground->bytes();
    }
    return *surface.ground;
}

PainterOptions Driver::painter_options(const view::DrawList& list, PlacedTiles& placed) {
    PainterOptions options{options_.target, options_.skips, options_.samples};
    options.sky = sky_.prepare(list);
    const std::vector<SeenTerrain> terrains = seen_terrains(list);
    if (!terrains.empty()) {
        const SeenTerrain& seen = terrains.front();
        options.detail = detail_.prepare(list, seen);
        options.facades = facades_.prepare(list, seen);
        if (options.facades != nullptr || scene::shown_grain(*seen.node) > 0.0F) {
            const view::GrainView view = view::grain_view(list, *seen.node, seen.world_from_local);
            options.grain = grain_.prepare(list, seen, view);
            set_normals(view, placed);
        }
        options.world_from_normal =
            glm::mat3(glm::inverseTranspose(glm::dmat3(seen.world_from_local)));
        options.contours = {static_cast<float>(scene::shown_contours(*terrains.front().node)),
                            static_cast<float>(view::contour_scale(list.camera, list.size))};
    }
    return options;
}

Result<std::unique_ptr<const MeshFrame>> Driver::mesh_frame(const StreamedList& frame,
                                                            const PlacedTiles& placed) {
    const view::DrawList& list = frame.list;
    if (list.meshes.empty() && list.meshes_beside.empty()) {
        return std::unique_ptr<const MeshFrame>();
    }
    const std::vector<SeenTerrain> terrains = seen_terrains(list);
    MeshFrame::Options options;
    if (!terrains.empty() && casts_shadows(terrains.front())) {
        const SeenTerrain& seen = terrains.front();
        auto beside = seen.has_tiles ? streamed_.beside(seen.node->stream->maker(), tiles_of(list),
                                                        frame.above)
                                     : std::vector<SunSource>();
        options.ground = shadow_ground(list, seen, placed, std::move(beside));
    }
    if (list.meshes.empty() && !options.ground) {
        return std::unique_ptr<const MeshFrame>(); // those beside the picture cast no shadows
    }
    auto meshes = mesh_trees_.place(list.meshes, list.meshes_beside, list.camera.eye);
    if (!meshes) {
        return meshes.error();
    }
    mesh_pictures_.prepare(*meshes);
    options.anchor = placed.tiles.empty() ? 0.0 : placed.tiles.front().rays.anchor;
    options.kernel = block_kernel(options_.target.value_or(SimdTarget{}).bit);
    options.skips = options_.skips;
    return std::unique_ptr<const MeshFrame>(
        std::make_unique<MeshFrame>(list, std::move(*meshes), mesh_pictures_, std::move(options)));
}

void Driver::paint(const view::DrawList& list, const PlacedTiles& placed,
                   const PainterOptions& options) {
    // Of a pixel's width: a step of this depth shows another surface.
    constexpr double step_in_pixels = 2.0;
    const glm::vec2 pixel = scene::metres_a_pixel(list.camera, list.size);
    first_.is_perspective = list.camera.projection == scene::ProjectionKind::perspective;
    first_.samples_all = options_.samples_all;
    first_.disagreement =
        static_cast<float>(step_in_pixels) * (first_.is_perspective ? pixel.y : pixel.x);
    Painter painter(list, placed, options, first_);
    ParallelOptions parallel;
    parallel.threads = options_.threads;
    for_each_block(list.size, parallel, [&](const PixelBlock& block, std::size_t index) {
        painter.paint(block, index);
    });
    if (painter.has_samples()) {
        for_each_block(list.size, parallel, [&](const PixelBlock& block, std::size_t index) {
            painter.choose_sampled(block, index);
        });
        for_each_block(list.size, parallel, [&](const PixelBlock& block, std::size_t index) {
            painter.sample(block, index);
        });
    }
}

view::PictureWork Driver::count(const view::DrawList& list, const PlacedTiles& placed) {
    view::PictureWork work{Grid<view::PixelWork>(list.size.x, list.size.y)};
    Painter painter(list, placed, {options_.target, options_.skips, 1}, first_);
    std::vector<std::size_t> beam_taps(static_cast<std::size_t>(block_count(list.size)));
    ParallelOptions parallel;
    parallel.threads = options_.threads;
    for_each_block(list.size, parallel, [&](const PixelBlock& block, std::size_t index) {
        beam_taps[index] = painter.count(block, index, work.pixels);
    });
    work.beam_taps = std::accumulate(beam_taps.begin(), beam_taps.end(), std::size_t{0});
    return work;
}

Result<view::PictureWork> Driver::count_work(const view::FrameView& frame) {
    if (auto possible = check_support(frame.list); !possible) {
        return possible.error();
    }
    const StreamedList streamed = with_searched_tiles(frame.list);
    view::FrameStats stats;
    return count(streamed.list, placed_tiles(streamed, true, stats));
}

Result<view::FrameStats> Driver::draw(const view::FrameView& frame, bool keeps_depths) {
    const Stopwatch watch;
    if (auto possible = check_support(frame.list); !possible) {
        return possible.error();
    }
    if (!options_.keeps_content) {
        forget_content();
    }
    const StreamedList streamed = with_searched_tiles(frame.list);
    view::FrameStats stats = frame.list.stats;
    PlacedTiles placed = placed_tiles(streamed, true, stats);
    PainterOptions painting = painter_options(streamed.list, placed);
    const auto meshes = mesh_frame(streamed, placed);
    if (!meshes) {
        return meshes.error();
    }
    painting.meshes = meshes->get();
    const glm::ivec2 kept = keeps_depths ? size() : glm::ivec2(0);
    if (glm::ivec2(depths_.cols(), depths_.rows()) != kept) {
        depths_ = Grid<float>(kept.x, kept.y);
    }
    painting.depths = keeps_depths ? &depths_ : nullptr;
    paint(streamed.list, placed, painting);
    stats.rays = ray_count(streamed.list, placed);
    stats.tiles = tile_count(streamed.list, placed);
    stats.cpu_ms = watch.milliseconds();
    return stats;
}

Result<view::DrawnHits> Driver::draw_hits(const view::FrameView& frame) {
    if (auto possible = check_support(frame.list); !possible) {
        return possible.error();
    }
    const StreamedList streamed = with_searched_tiles(frame.list);
    view::FrameStats stats = frame.list.stats;
    const PlacedTiles placed = placed_tiles(streamed, false, stats);
    CastOptions options;
    options.parallel.threads = options_.threads;
    options.target = options_.target;
    options.skips = options_.skips;
    auto hits = cast_hits(placed, frame.list.size, options);
    if (!hits) {
        return hits.error();
    }
    const auto meshes = mesh_frame(streamed, placed);
    if (!meshes) {
        return meshes.error();
    }
    if (*meshes != nullptr) {
        (*meshes)->add_hits(*hits, options.parallel);
    }
    stats.rays = ray_count(streamed.list, placed);
    stats.tiles = tile_count(streamed.list, placed);
    return view::DrawnHits{std::move(*hits), stats};
}

} // namespace reljef::cast
