#include "engine/cast/frame/driver.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/cast/block_kernel.h"
#include "engine/cast/block_rays.h"
#include "engine/cast/cast_hits.h"
#include "engine/cast/frame/base_walls.h"
#include "engine/cast/frame/sun_tiles.h"
#include "engine/core/stopwatch.h"
#include "engine/scene/streaming/tile_stream.h"

namespace reljef::cast {

namespace {

// No pixel of a proven tile is farther off than the tile itself, and the rays (`of_rays`). Empty:
// none is proven.
std::optional<double> kept_error(const view::DrawList& list, double of_rays) {
    std::optional<double> largest;
    if (list.tiles.empty()) {
        largest = 0.0; // the samples
    }
    for (const view::TileDraw& draw : list.tiles) {
        if (draw.is_proven()) {
            largest = std::max(largest.value_or(0.0), draw.tile->borrows ? 0.0 : draw.error);
        }
    }
    return largest ? std::optional(*largest + of_rays) : largest;
}

// The finest tiles of reliefs over streams as tiles, and the others, above them.
StreamedList with_tiles_of_reliefs(view::DrawList list) {
    StreamedList made;
    for (view::TerrainDraw& relief : list.reliefs) {
        std::set<terrain::TreeTile> above;
        for (const auto& tile : relief.tiles) {
            terrain::TreeTile id = tile->id;
            const int top = relief.tiles.front()->id.level;
            while (id.level < top) {
                id = {id.level + 1, id.col / 2, id.row / 2};
                above.insert(id);
            }
        }
        for (const auto& tile : relief.tiles) {
            if (above.contains(tile->id)) {
                made.above.push_back(tile);
                continue;
            }
            view::TileDraw& draw = list.tiles.emplace_back();
            draw.terrain = relief.terrain;
            draw.tile = tile;
            draw.node = list.terrains.size();
        }
        list.terrains.push_back(
            {.terrain = relief.terrain, .world_from_local = relief.world_from_local});
    }
    std::erase_if(list.reliefs,
                  [](const view::TerrainDraw& relief) { return !relief.tiles.empty(); });
    made.list = std::move(list);
    return made;
}

// Tiles of a stream are drawn in up to four pieces.
int tile_count(const view::DrawList& list, const PlacedTiles& placed) {
    return static_cast<int>(list.tiles.empty() ? placed.tiles.size() : list.tiles.size());
}

bool is_perspective(const view::DrawList& list) {
    return list.camera.projection == scene::ProjectionKind::perspective;
}

// World directions of the rays.
PictureRays::Vectors view_of(const view::DrawList& list) {
    const auto at = [&](glm::dvec2 pixel) {
        return scene::view_ray(list.camera, list.size, pixel).direction;
    };
    const glm::dvec2 extent(list.size);
    const glm::dvec3 first = at({0.0, 0.0});
    return {first, (at({extent.x, 0.0}) - first) / extent.x,
            (at({0.0, extent.y}) - first) / extent.y};
}

BlockPaint backdrop_of(const view::DrawList& list) {
    BlockPaint paint;
    if (list.sky) {
        paint.has_sky = true;
        const scene::Sky& sky = *list.sky;
        const scene::AirSeen air = scene::air_seen(sky, list.camera);
        paint.horizon = sky.horizon;
        paint.zenith = sky.zenith;
        paint.glow = sky.glow;
        paint.curve = sky.curve;
        paint.has_plane = air.has_plane;
        paint.plane = sky.plane.value_or(glm::vec3(0.0F));
        // On a map there is no viewing distance.
        paint.has_air = is_perspective(list) && sky.visibility > 0.0;
        paint.extinction = air.extinction;
        paint.eye_above = air.eye_above;
        paint.eye_density = air.eye_density;
        paint.per_height = air.per_height;
    }
    if (list.sun) {
        paint.has_sun = true;
        paint.sun = list.sun->color;
        paint.to_sun = glm::vec3(scene::to_light(*list.sun));
    }
    return paint;
}

// The bytes of a pixel are those of Rgba8.
static_assert(std::endian::native == std::endian::little);

void write_block(const BlockPixels& pixels, const PixelBlock& block, Image& picture) {
    const auto width = static_cast<std::size_t>(block.size.x);
    for (int row = 0; row < block.size.y; ++row) {
        const std::uint32_t* const from =
            pixels.rgba.data() + static_cast<std::size_t>(row) * block_side;
        Rgba8* const to = &picture(block.first.x, block.first.y + row);
        std::memcpy(static_cast<void*>(to), from, width * sizeof(Rgba8));
    }
}

} // namespace

double rounding_error(const scene::Camera& camera, glm::ivec2 size) {
    // Floats have errors of 2^-24 of the distance, and a place on a ray adds a few of them.
    constexpr double of_distance = 0x1p-20;
    const glm::vec2 pixel = view::metres_a_pixel(camera, size);
    return camera.projection == scene::ProjectionKind::perspective
               ? of_distance / pixel.y
               : of_distance * (camera.orthographic_far - camera.orthographic_near) / pixel.x;
}

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

const RayTile& Driver::tile_of(const scene::TerrainNode& terrain, view::FrameStats& stats) {
    Surface& surface = surface_of(terrain.surface);
    if (surface.tile == nullptr) {
        surface.tile =
            std::make_shared<const RayTile>(terrain.surface->heightfield().heights.view());
        ++stats.uploads;
        stats.upload_bytes += surface.tile->bytes();
    } else {
        ++stats.skipped.uploads_unchanged;
    }
    return *surface.tile;
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
    made = {light, nullptr, nullptr};
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
    surface_of(request.surface).light = {request.light, levels_over(surface, prepared.lit),
                                         request.in_parts ? levels_over(surface, prepared.sun)
                                                          : nullptr};
    return {};
}

void Driver::forget_content() {
    surfaces_.clear();
    streamed_ = {};
}

namespace {

struct RaysOver {
    PictureRays straight; // in samples; over the ellipsoid only their range and anchor
    std::shared_ptr<const CurvedRays> curve;
};

RaysOver rays_over(const view::DrawList& list, const SeenTerrain& seen, unsigned threads) {
    const terrain::Placement& placement = seen.node->surface->placement();
    if (!is_curved(*seen.node)) {
        return {
            picture_rays(list.camera, list.size, seen.world_from_local, placement, seen.samples),
            nullptr};
    }
    auto curve = std::make_shared<const CurvedRays>(
        list.camera, list.size,
        CurvedRays::Terrain{placement, seen.world_from_local, seen.local, seen.samples}, threads);
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

// Where hits have the light of the sun: its map has no shadows. Of a terrain on a plane.
void add_sun(const view::DrawList& list, const SeenTerrain& seen, std::span<const SunSource> beside,
             PlacedTiles& placed) {
    const auto light = view::light_on(list, seen.world_from_local);
    if (!light) {
        return;
    }
    const glm::dvec3 local = glm::inverse(light->world_from_local) * scene::to_light(light->sun);
    const scene::TerrainNode& node = *seen.node;
    glm::dvec3 to_sun = direction_in_samples(node.surface->placement(), local);
    if (seen.has_tiles) {
        to_sun *= glm::dvec3(glm::dvec2(node.stream->maker().reduction()), 1.0);
    }
    if (to_sun.z > 0.0) { // else there is no such light
        add_sun_tiles(placed, beside, to_sun);
    }
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
    const auto [rays, curve] = rays_over(list, seen, options_.threads);
    const bool stands_in = node.stream != nullptr && !seen.has_tiles; // for tiles to be loaded
    if (scene::error_bound(node.material.technique) > 0.0 && !stands_in) {
        stats.kept_error = kept_error(list, rounding_error(list.camera, list.size) +
                                                (curve != nullptr ? curve->error() : 0.0));
    }
    if (seen.has_tiles) {
        const bool in_parts = node.material.technique.options.shadow.has_value();
        PlacedTiles placed = streamed_.place(
            list, rays, {options_.threads, paints, curve != nullptr, in_parts}, stats);
        placed.curve = curve;
        if (paints && in_parts) {
            add_sun(list, seen, streamed_.beside(node.stream->maker(), tiles_of(list), frame.above),
                    placed);
        }
        return placed;
    }
    PlacedTiles placed;
    placed.curve = curve;
    placed.has_walls = curve != nullptr;
    PlacedTile& tile = placed.tiles.emplace_back();
    tile.tile = &tile_of(node, stats);
    tile.rays = rays;
    tile.seen = {{0, 0}, list.size};
    if (paints) {
        paint_surface(list, seen, tile, stats);
        if (node.material.technique.options.shadow) {
            add_sun(list, seen, {}, placed);
        }
    }
    return placed;
}

// A terrain in memory.
void Driver::paint_surface(const view::DrawList& list, const SeenTerrain& seen, PlacedTile& tile,
                           view::FrameStats& stats) {
    const auto on = view::light_on(list, seen.world_from_local);
    const terrain::Placement& placement = seen.node->surface->placement();
    const Light& light = light_of(*seen.node, on, stats);
    tile.paint = light.levels->paint();
    tile.paint.longest_texels = longest_texels(list, tile.paint, placement.spacing());
    if (light.sun != nullptr) {
        tile.sun = light.sun->paint();
    }
}

namespace {

// Draws the blocks of a picture.
class Painter {
public:
    Painter(const view::DrawList& list, const PlacedTiles& placed, const DriverOptions& options,
            FirstSamples& first)
        : placed_(placed), kernel_(block_kernel(options.target.value_or(SimdTarget{}).bit)),
          shared_(backdrop_of(list)), view_(view_of(list)), walls_(base_walls(list)), first_(first),
          jobs_(static_cast<std::size_t>(block_count(list.size))) {
        shared_.anchor =
            placed.tiles.empty() ? 0.0F : static_cast<float>(placed.tiles.front().rays.anchor);
        const std::span<const glm::ivec2> places = sixteenths_of(options.samples);
        samples_.samples = static_cast<int>(places.size());
        shared_.is_perspective = first.is_perspective;
        shared_.needs_nearness = has_samples();
        std::transform(places.begin(), places.end(), samples_.places.begin(),
                       [](glm::ivec2 place) { return glm::vec2(place) / 16.0F; });
    }

    void paint(const PixelBlock& block, std::size_t index) {
        std::vector<BlockJob> jobs = block_jobs(placed_, block, true);
        BlockPixels pixels;
        kernel_.paint({jobs, placed_.has_walls}, paint_of(block, index), pixels);
        write_block(pixels, block, first_.picture);
        if (samples_.samples > 1) {
            write_nearness(pixels, block);
            jobs_[index] = std::move(jobs);
        }
    }

    // Where surfaces end. `picture`: the result.
    void sample(const PixelBlock& block, std::size_t index, Image& picture) {
        SampledPixels sampled;
        sampled.samples = samples_.samples;
        sampled.places = samples_.places;
        choose_sampled(first_, kernel_, block, sampled);
        if (sampled.count == 0) {
            return;
        }
        BlockPixels pixels;
        kernel_.sample({jobs_[index], placed_.has_walls}, paint_of(block, index), sampled, pixels);
        for (int i = 0; i < sampled.count; ++i) {
            const int pixel = sampled.pixels[static_cast<std::size_t>(i)];
            std::memcpy(static_cast<void*>(&picture(block.first.x + pixel % block_side,
                                                    block.first.y + pixel / block_side)),
                        &pixels.rgba[static_cast<std::size_t>(pixel)], sizeof(Rgba8));
        }
    }

    [[nodiscard]] bool has_samples() const { return samples_.samples > 1; }

private:
    [[nodiscard]] BlockPaint paint_of(const PixelBlock& block, std::size_t index) const {
        BlockPaint paint = shared_;
        if (!walls_.empty()) {
            paint.walls = walls_[index];
        }
        const glm::dvec2 middle = glm::dvec2(block.first) + 0.5 * block_side;
        paint.view = {glm::vec3(view_.at(middle)), glm::vec3(view_.right), glm::vec3(view_.down)};
        paint.from_corner = glm::vec2(middle.x, first_.picture.rows() - middle.y);
        return paint;
    }

    void write_nearness(const BlockPixels& pixels, const PixelBlock& block) {
        for (int row = 0; row < block.size.y; ++row) {
            const float* const from =
                pixels.nearness.data() + static_cast<std::size_t>(row) * block_side;
            std::copy_n(from, block.size.x, first_.nearness_at(block.first + glm::ivec2(0, row)));
        }
    }

    const PlacedTiles& placed_;
    BlockKernel kernel_;
    BlockPaint shared_;
    PictureRays::Vectors view_;
    std::vector<std::vector<WallTriangle>> walls_; // of the blocks; empty: none
    FirstSamples& first_;
    std::vector<std::vector<BlockJob>> jobs_; // of the blocks, for their samples
    SampledPixels samples_;
};

} // namespace

void Driver::paint(const view::DrawList& list, const PlacedTiles& placed) {
    // Of a pixel's width: a step of this depth shows another surface.
    constexpr double step_in_pixels = 2.0;
    const glm::vec2 pixel = view::metres_a_pixel(list.camera, list.size);
    first_.is_perspective = is_perspective(list);
    first_.samples_all = options_.samples_all;
    first_.disagreement =
        static_cast<float>(step_in_pixels) * (first_.is_perspective ? pixel.y : pixel.x);
    Painter painter(list, placed, options_, first_);
    ParallelOptions parallel;
    parallel.threads = options_.threads;
    for_each_block(list.size, parallel, [&](const PixelBlock& block, std::size_t index) {
        painter.paint(block, index);
    });
    if (painter.has_samples()) {
        picture_ = first_.picture;
        for_each_block(list.size, parallel, [&](const PixelBlock& block, std::size_t index) {
            painter.sample(block, index, picture_);
        });
        std::swap(first_.picture, picture_);
    }
}

Result<view::FrameStats> Driver::draw(const view::FrameView& frame) {
    const Stopwatch watch;
    if (auto possible = check_support(frame.list); !possible) {
        return possible.error();
    }
    const StreamedList streamed = with_tiles_of_reliefs(frame.list);
    view::FrameStats stats = frame.list.stats;
    const PlacedTiles placed = placed_tiles(streamed, true, stats);
    paint(streamed.list, placed);
    stats.rays = placed.tiles.empty() ? 0 : first_.picture.size();
    stats.tiles = tile_count(streamed.list, placed);
    stats.cpu_ms = watch.milliseconds();
    return stats;
}

Result<view::DrawnHits> Driver::draw_hits(const view::FrameView& frame) {
    if (auto possible = check_support(frame.list); !possible) {
        return possible.error();
    }
    const StreamedList streamed = with_tiles_of_reliefs(frame.list);
    const glm::ivec2 size = frame.list.size;
    view::DrawnHits drawn{HitBuffer(size.x, size.y), frame.list.stats};
    const PlacedTiles placed = placed_tiles(streamed, false, drawn.stats);
    CastOptions options;
    options.parallel.threads = options_.threads;
    options.target = options_.target;
    auto hits = cast_hits(placed, size, options);
    if (!hits) {
        return hits.error();
    }
    drawn.hits = std::move(*hits);
    drawn.stats.rays = placed.tiles.empty() ? 0 : drawn.hits.size();
    drawn.stats.tiles = tile_count(streamed.list, placed);
    return drawn;
}

} // namespace reljef::cast
