#include "engine/cast/driver.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "engine/cast/block_rays.h"
#include "engine/cast/cast_hits.h"
#include "engine/core/stopwatch.h"

namespace reljef::cast {

// A terrain of a frame.
struct Driver::PlacedTerrain {
    const scene::TerrainNode* node = nullptr;
    glm::dmat4 world_from_local{1.0};
    const RayTile* tile = nullptr;
    PictureRays rays;
    const LitLevels* levels = nullptr;
};

namespace {

struct SeenTerrain {
    const scene::TerrainNode* node = nullptr;
    glm::dmat4 world_from_local{1.0};
};

// Each once.
std::vector<SeenTerrain> terrains_of(const view::DrawList& list) {
    std::vector<SeenTerrain> seen;
    const auto add = [&](const scene::TerrainNode* node, const glm::dmat4& world_from_local) {
        const bool is_new = std::none_of(
            seen.begin(), seen.end(), [&](const SeenTerrain& other) { return other.node == node; });
        if (is_new) {
            seen.push_back({node, world_from_local});
        }
    };
    for (const view::ReliefDraw& draw : list.reliefs) {
        add(draw.terrain, draw.world_from_local);
    }
    for (const view::TileDraw& draw : list.tiles) {
        add(draw.terrain, list.world_from_local(draw));
    }
    return seen;
}

Box samples_and_heights(const scene::TerrainSurface& surface) {
    const Grid<float>& heights = surface.heightfield().heights;
    const terrain::MinMax total = surface.pyramid().total();
    Box bounds;
    bounds.add(glm::dvec3(0.0, 0.0, total.low));
    bounds.add(glm::dvec3(heights.cols() - 1.0, heights.rows() - 1.0, total.high));
    return bounds;
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
        paint.horizon = list.sky->horizon;
        paint.zenith = list.sky->zenith;
        // On a map there is no viewing distance.
        paint.extinction =
            is_perspective(list) ? static_cast<float>(scene::extinction(*list.sky)) : 0.0F;
    }
    if (list.sun) {
        paint.sun = list.sun->color;
        paint.to_sun = glm::vec3(scene::to_light(*list.sun));
    }
    return paint;
}

// An anisotropy of at most 8: over a silhouette a pixel's neighbours show other places.
glm::vec2 longest_texels(const view::DrawList& list, const PictureRays::Vectors& view,
                         glm::vec2 texels_per_sample, glm::dvec2 spacing) {
    if (!is_perspective(list)) {
        return {1e6F, 0.0F};
    }
    const glm::dvec2 per_metre = glm::dvec2(texels_per_sample) / spacing;
    constexpr double anisotropy = 8.0;
    return {0.0F, static_cast<float>(anisotropy * glm::length(view.right) *
                                     std::max(per_metre.x, per_metre.y))};
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

bool draws_technique(const scene::Technique& technique) {
    return technique.options == scene::TechniqueOptions{} &&
           (technique.id() == scene::TechniqueId::exact || scene::error_bound(technique) > 0.0);
}

std::string obstacle_of(const scene::TerrainNode& terrain, const scene::Technique& technique) {
    if (!draws_technique(technique)) {
        return fmt::format("technique {}", scene::to_string(technique));
    }
    if (terrain.stream != nullptr) {
        return "a streamed terrain";
    }
    if (terrain.surface->placement().kind() != terrain::PlacementKind::plane) {
        return "placement ellipsoid";
    }
    if (terrain.material.wireframe) {
        return "a wireframe";
    }
    const double samples = static_cast<double>(terrain.surface->heightfield().heights.size());
    if (samples > std::numeric_limits<std::int32_t>::max()) {
        return "a terrain of more than 2^31 samples";
    }
    return terrain.detail != nullptr ? "a detail texture" : "";
}

std::string obstacle_of(const view::DrawList& list) {
    if (!list.meshes.empty()) {
        return "a mesh";
    }
    const std::vector<SeenTerrain> terrains = terrains_of(list);
    for (const SeenTerrain& terrain : terrains) {
        if (auto found = obstacle_of(*terrain.node, terrain.node->material.technique);
            !found.empty()) {
            return found;
        }
    }
    return terrains.size() > 1 ? "more than one terrain" : "";
}

Result<void> check_support(const view::DrawList& list) {
    const std::string found = obstacle_of(list);
    return found.empty() ? Result<void>()
                         : Error{fmt::format("rays on the CPU: {} found, exact or an error bound "
                                             "over one terrain on a plane in memory was expected; "
                                             "--context osmesa draws the others",
                                             found)};
}

Driver::Driver(const DriverOptions& options)
    : options_(options), picture_(options.size.x, options.size.y) {}

Result<Driver> Driver::create(const DriverOptions& options) {
    if (options.samples != 1 && options.samples != automatic_samples) {
        return Error{fmt::format("picture with {} samples a pixel: rays on the CPU found, 1 was "
                                 "expected; --context osmesa draws several",
                                 options.samples)};
    }
    Driver driver({.size = {1, 1}, .threads = options.threads, .target = options.target});
    auto sized = driver.resize(options.size);
    return sized ? Result<Driver>(std::move(driver)) : sized.error();
}

Result<void> Driver::resize(glm::ivec2 size) {
    constexpr int max_side = 1 << 14;
    if (size.x < 1 || size.y < 1 || size.x > max_side || size.y > max_side) {
        return Error{fmt::format("picture of {}x{} pixels: from 1x1 to {}x{} were expected", size.x,
                                 size.y, max_side, max_side)};
    }
    picture_ = Image(size.x, size.y);
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

const LitLevels& Driver::levels_of(const scene::TerrainNode& terrain,
                                   const std::optional<scene::TerrainLight>& light,
                                   view::FrameStats& stats) {
    Surface& surface = surface_of(terrain.surface);
    if (surface.light.levels == nullptr || surface.light.light != light) {
        const Grid<float>& heights = terrain.surface->heightfield().heights;
        surface.light = {light, std::make_shared<const LitLevels>(
                                    view::lit_map(*terrain.surface, light, max_texture_side()),
                                    glm::ivec2(heights.cols(), heights.rows()))};
        ++stats.uploads;
        stats.upload_bytes += surface.light.levels->bytes();
    } else {
        ++stats.skipped.uploads_unchanged;
    }
    return *surface.light.levels;
}

Result<void> Driver::add_light(const view::PreparedLight& prepared) {
    const view::LightRequest& request = prepared.request;
    if (request.stream != nullptr || request.in_parts) {
        return {}; // not drawn by rays
    }
    const Grid<float>& heights = request.surface->heightfield().heights;
    surface_of(request.surface).light = {
        request.light, std::make_shared<const LitLevels>(
                           prepared.lit, glm::ivec2(heights.cols(), heights.rows()))};
    return {};
}

void Driver::paint(const view::DrawList& list, const std::optional<PlacedTerrain>& terrain,
                   view::FrameStats& stats) {
    BlockPaint shared = backdrop_of(list);
    const PictureRays::Vectors view = view_of(list);
    if (terrain) {
        terrain->levels->add_to(shared);
        shared.anchor = static_cast<float>(terrain->rays.anchor);
        shared.longest_texels = longest_texels(list, view, shared.levels[0].texels_per_sample,
                                               terrain->node->surface->placement().spacing());
    }
    const BlockKernel kernel = block_kernel(options_.target.value_or(SimdTarget{}).bit);
    const auto paint_one = [&](const PixelBlock& block) {
        BlockPaint own = shared;
        const glm::dvec2 middle = glm::dvec2(block.first) + 0.5 * block_side;
        own.view = {glm::vec3(view.at(middle)), glm::vec3(view.right), glm::vec3(view.down)};
        BlockPixels pixels;
        const auto job = terrain ? block_job(*terrain->tile, terrain->rays, block, true)
                                 : std::optional<BlockJob>();
        kernel.paint(job ? *job : empty_job(), own, pixels);
        write_block(pixels, block, picture_);
    };
    ParallelOptions parallel;
    parallel.threads = options_.threads;
    for_each_block(list.size, parallel, paint_one);
    stats.rays = terrain ? picture_.size() : 0;
    stats.tiles = terrain ? 1 : 0;
}

Result<view::FrameStats> Driver::draw(const view::FrameView& frame) {
    const Stopwatch watch;
    const view::DrawList& list = frame.list;
    if (auto possible = check_support(list); !possible) {
        return possible.error();
    }
    view::FrameStats stats = list.stats;
    const std::vector<SeenTerrain> seen = terrains_of(list);
    std::optional<PlacedTerrain> terrain;
    for (const auto& [node, world_from_local] : seen) {
        const RayTile& tile = tile_of(*node, stats);
        const LitLevels& levels = levels_of(*node, view::light_on(list, world_from_local), stats);
        terrain = PlacedTerrain{node, world_from_local, &tile,
                                picture_rays(list.camera, list.size, world_from_local,
                                             node->surface->placement(),
                                             samples_and_heights(*node->surface)),
                                &levels};
        if (scene::error_bound(node->material.technique) > 0.0) {
            stats.kept_error = 0.0;
        }
    }
    paint(list, terrain, stats);
    stats.cpu_ms = watch.milliseconds();
    return stats;
}

Result<view::DrawnHits> Driver::draw_hits(const view::FrameView& frame) {
    const view::DrawList& list = frame.list;
    if (auto possible = check_support(list); !possible) {
        return possible.error();
    }
    view::DrawnHits drawn{HitBuffer(list.size.x, list.size.y), list.stats};
    for (const auto& [node, world_from_local] : terrains_of(list)) {
        CastOptions options;
        options.parallel.threads = options_.threads;
        options.target = options_.target;
        auto hits =
            cast_hits(tile_of(*node, drawn.stats),
                      picture_rays(list.camera, list.size, world_from_local,
                                   node->surface->placement(), samples_and_heights(*node->surface)),
                      options);
        if (!hits) {
            return hits.error();
        }
        drawn.hits = std::move(*hits);
        drawn.stats.rays = drawn.hits.size();
        drawn.stats.tiles = 1;
        if (scene::error_bound(node->material.technique) > 0.0) {
            drawn.stats.kept_error = 0.0;
        }
    }
    return drawn;
}

} // namespace reljef::cast
