#include "engine/cast/cast_hits.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>

#include "engine/cast/block_kernel.h"
#include "engine/cast/block_rays.h"

namespace reljef::cast {
namespace {

// A hit, or sky.
Hit hit_in(const BlockHits& hits, const BlockRays& rays, std::size_t pixel, double anchor) {
    if (!(hits.t[pixel] < std::numeric_limits<float>::infinity())) {
        return {};
    }
    const glm::dvec2 place(hits.col[pixel] + static_cast<double>(hits.col_part[pixel]),
                           hits.row[pixel] + static_cast<double>(hits.row_part[pixel]));
    return hit_at(place, static_cast<double>(rays.base_height) + hits.height[pixel],
                  anchor + hits.t[pixel]);
}

void copy_hits(const BlockHits& found, const BlockRays& rays, const PixelBlock& block,
               double anchor, HitBuffer& hits) {
    for (int row = 0; row < block.size.y; ++row) {
        for (int col = 0; col < block.size.x; ++col) {
            const auto pixel =
                static_cast<std::size_t>(row) * block_side + static_cast<std::size_t>(col);
            hits(block.first.x + col, block.first.y + row) = hit_in(found, rays, pixel, anchor);
        }
    }
}

} // namespace

Result<HitBuffer> cast_hits(const RayTile& tile, const PictureRays& rays,
                            const CastOptions& options) {
    HitBuffer hits(rays.size.x, rays.size.y);
    const BlockKernel kernel = block_kernel(options.target.value_or(SimdTarget{}).bit);
    const auto cast = [&](const PixelBlock& block) {
        const auto job = block_job(tile, rays, block, options.beams);
        if (job) {
            BlockHits found;
            kernel.cast(*job, found);
            copy_hits(found, job->rays, block, rays.anchor, hits);
        }
    };
    if (!for_each_block(rays.size, options.parallel, cast)) {
        return Error{"hits by rays on the CPU: casting was stopped"};
    }
    return hits;
}

} // namespace reljef::cast
