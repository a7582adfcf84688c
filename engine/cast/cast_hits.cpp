#include "engine/cast/cast_hits.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <glm/common.hpp>

#include "engine/cast/block_rays.h"
#include "engine/cast/packet/block_kernel.h"

namespace reljef::cast {
namespace {

// A hit, or sky.
Hit hit_in(const BlockHits& hits, const PlacedTile& tile, const geo::WrappedRows& rows,
           const BlockRays& rays, std::size_t pixel) {
    const glm::dvec2 place(hits.col[pixel] + static_cast<double>(hits.col_part[pixel]),
                           hits.row[pixel] + static_cast<double>(hits.row_part[pixel]));
    const glm::dvec2 sample = tile.first + tile.step * place;
    return hit_at({sample.x, rows.from_even_row(sample.y)},
                  static_cast<double>(rays.base_height) + hits.height[pixel],
                  tile.rays.anchor + hits.t[pixel]);
}

class HitBlocks {
public:
    HitBlocks(const PlacedTiles& placed, const CastOptions& options, HitBuffer& hits)
        : placed_(placed), options_(options), hits_(hits),
          kernel_(block_kernel(options.target.value_or(SimdTarget{}).bit)) {}

    void cast(const PixelBlock& block) const {
        std::vector<std::size_t> tiles;
        std::vector<BlockJob> jobs = block_jobs(placed_, block, options_.skips, &tiles);
        if (jobs.empty()) {
            return;
        }
        BlockHits found;
        kernel_.cast({jobs, placed_.has_walls}, found);
        for (int row = 0; row < block.size.y; ++row) {
            for (int col = 0; col < block.size.x; ++col) {
                const auto pixel =
                    static_cast<std::size_t>(row) * block_side + static_cast<std::size_t>(col);
                if (found.t[pixel] < std::numeric_limits<float>::infinity()) {
                    const auto job = static_cast<std::size_t>(found.job[pixel]);
                    hits_(block.first.x + col, block.first.y + row) = hit_in(
                        found, placed_.tiles[tiles[job]], placed_.rows, jobs[job].rays, pixel);
                }
            }
        }
    }

private:
    const PlacedTiles& placed_;
    const CastOptions& options_;
    HitBuffer& hits_;
    BlockKernel kernel_;
};

} // namespace

Result<HitBuffer> cast_hits(const PlacedTiles& placed, glm::ivec2 size,
                            const CastOptions& options) {
    HitBuffer hits(size.x, size.y);
    const HitBlocks blocks(placed, options, hits);
    if (!for_each_block(
            size, options.parallel,
            [&](const PixelBlock& block, std::size_t /*index*/) { blocks.cast(block); })) {
        return Error{"hits by rays on the CPU: casting was stopped"};
    }
    return hits;
}

Result<HitBuffer> cast_hits(const RayTile& tile, const PictureRays& rays,
                            const CastOptions& options) {
    PlacedTiles placed;
    placed.tiles.push_back({.tile = &tile, .rays = rays, .seen = {{0, 0}, rays.size}});
    return cast_hits(placed, rays.size, options);
}

} // namespace reljef::cast
