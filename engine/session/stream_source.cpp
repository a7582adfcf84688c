#include "engine/session/stream_source.h"

#include <algorithm>
#include <bit>

#include "engine/core/parallel_for.h"
#include "engine/io/raster/raster.h"
#include "engine/io/tree_tile.h"
#include "engine/scene/streaming/tile_stream.h"

namespace reljef::session {
namespace {

// Shares of the memory if the terrain does not fit: an eighth each for its overview, for GDAL's
// block cache, and for reading and uploading; the rest is for tiles.
constexpr std::size_t overview_part = 8;
constexpr std::size_t blocks_part = 8;
constexpr std::size_t work_part = 8;
// If only images do not fit, the overview may take up to a half; a quarter of that is its picture.
constexpr std::size_t whole_part = 2;

std::size_t bytes_of(const io::TileGrid& grid) {
    return io::bytes_per_sample * static_cast<std::size_t>(grid.cols) *
           static_cast<std::size_t>(grid.rows);
}

std::size_t with_picture(std::size_t bytes_of_heights) {
    return bytes_of_heights / 3 * 4;
}

// The overviews of files are halvings: such a reduction reads the least before the first picture.
std::size_t budget_of_halves(const io::TileSet::TerrainPlan& plan) {
    const auto reduction = std::bit_ceil(static_cast<unsigned>(plan.reduction));
    return bytes_of(io::TileSet::reduced(plan.grid, static_cast<int>(reduction)));
}

// Memory of a thread that reads tiles of heights, or with pictures, bytes.
constexpr std::size_t bytes_of_reader = std::size_t{4} << 20U;
constexpr std::size_t bytes_of_picture_reader = std::size_t{8} << 20U;

unsigned readers_within(const io::TileTerrainOptions& options) {
    const std::size_t each =
        options.raster.imagery.empty() ? bytes_of_reader : bytes_of_picture_reader;
    const std::size_t max_threads =
        std::max<std::size_t>(1, options.raster.memory_budget / work_part / each);
    return static_cast<unsigned>(std::min<std::size_t>(thread_count(options.threads), max_threads));
}

bool fits(const Result<io::TileSet::TerrainPlan>& plan) {
    return plan && plan->reduction == 1;
}

struct OverviewPlan {
    io::TileSet::TerrainPlan plan;
    std::size_t budget = 0; // bytes
    std::size_t share = 0;  // of the memory, bytes
};

std::optional<OverviewPlan> overview_plan(const io::TileSet& tiles, io::TileTerrainOptions options,
                                          const Result<io::TileSet::TerrainPlan>& whole) {
    const std::size_t memory = options.raster.memory_budget;
    if (fits(whole)) {
        const std::size_t bytes = with_picture(bytes_of(whole->grid));
        if (bytes <= memory / whole_part) {
            return OverviewPlan{*whole, bytes, bytes};
        }
    }
    options.raster.memory_budget = memory / overview_part;
    auto plan = tiles.plan(options);
    if (plan) {
        options.raster.memory_budget = budget_of_halves(*plan);
        plan = tiles.plan(options);
    }
    return plan ? std::optional(
                      OverviewPlan{*plan, options.raster.memory_budget, memory / overview_part})
                : std::nullopt;
}

// Sides of the finest image's pixels, samples.
double finest_pixel_of(const io::ImagerySet& imagery, const io::TileGrid& grid) {
    const glm::dvec2 pixels =
        imagery.finest_pixels_in(io::texels_at(grid)).value_or(glm::dvec2(1.0));
    return 1.0 / std::max(pixels.x, pixels.y);
}

// Makes texels of the finest tiles at most as large as pixels of the finest image: `texel` and
// `pixel` in samples.
int refinement_for(const StreamSource& stream, double texel, double pixel) {
    constexpr int max_refinement = 64;
    const int limit =
        std::min(max_refinement, terrain::max_tree_samples /
                                     std::max(stream.plan.grid.cols, stream.plan.grid.rows));
    int refinement = 1;
    while (2 * refinement <= limit && texel > 1.001 * refinement * pixel) {
        refinement *= 2;
    }
    return refinement;
}

} // namespace

Result<std::shared_ptr<const io::ImagerySet>> open_imagery(const io::TileSet& tiles,
                                                           const SourceOptions& choice,
                                                           const io::TileTerrainOptions& options) {
    const auto plan = tiles.plan(options);
    const bool shown = choice.pictures_streamed || !fits(plan);
    if (!choice.streamed || options.raster.imagery.empty() || !shown) {
        return std::shared_ptr<const io::ImagerySet>();
    }
    io::ImagerySetOptions opening;
    opening.reading_memory = options.raster.memory_budget / work_part / readers_within(options);
    opening.stop = options.raster.stop;
    const io::TileGrid grid = plan ? plan->grid : tiles.grid();
    auto imagery =
        io::ImagerySet::open(options.raster.imagery, tiles.imagery_ground(grid), opening);
    if (!imagery) {
        return imagery.error();
    }
    return std::make_shared<const io::ImagerySet>(std::move(*imagery));
}

bool has_finer_pictures(const io::TileSet& tiles, const io::TileTerrainOptions& options,
                        const io::ImagerySet* imagery) {
    const auto plan = tiles.plan(options);
    return plan && imagery != nullptr && imagery->finest_pixels_in(io::texels_at(plan->grid)) &&
           std::max(plan->grid.cols, plan->grid.rows) >
               io::max_image_side * finest_pixel_of(*imagery, plan->grid);
}

std::optional<StreamSource> stream_source(const io::TileSet& tiles, const SourceOptions& choice,
                                          io::TileTerrainOptions options,
                                          const io::ImagerySet* imagery) {
    const auto whole = tiles.plan(options);
    if (!choice.streamed || (fits(whole) && !has_finer_pictures(tiles, options, imagery)) ||
        std::max(tiles.grid().cols, tiles.grid().rows) > terrain::max_tree_samples) {
        return std::nullopt;
    }
    const auto overview = overview_plan(tiles, options, whole);
    if (!overview) {
        return std::nullopt;
    }
    const std::size_t memory = options.raster.memory_budget;
    io::limit_block_cache(memory / blocks_part);
    StreamSource stream;
    stream.plan = overview->plan;
    stream.overview_budget = overview->budget;
    stream.gaps = options.gaps;
    stream.memory_budget = memory - overview->share - memory / blocks_part - memory / work_part;
    stream.threads = readers_within(options);
    if (fits(whole)) {
        const std::size_t needed = whole_part * with_picture(bytes_of(whole->grid));
        stream.megabytes_for_all_heights = (needed >> 20U) + 1;
    }
    return stream;
}

scene::ImageryDetail imagery_detail(const io::ImagerySet& imagery, const StreamSource& stream,
                                    double spacing) {
    const double pixel = finest_pixel_of(imagery, stream.plan.grid);
    scene::ImageryDetail detail;
    detail.max_texels = scene::TileStream::texels_within(stream.memory_budget);
    detail.finest_pixel = pixel * spacing;
    detail.refinement = refinement_for(stream, 1.0 / detail.max_texels, pixel);
    return detail;
}

} // namespace reljef::session
