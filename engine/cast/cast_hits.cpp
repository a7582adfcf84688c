#include "engine/cast/cast_hits.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <span>
#include <vector>

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include "engine/cast/block_rays.h"
#include "engine/cast/packet/block_kernel.h"

namespace reljef::cast {
namespace {

// A cell and a part of it, as a float and what it rounds off (Dekker 1971). Exact below 2^24.
struct SplitPlace {
    float high;
    float low;

    SplitPlace(int cell, float part) {
        const auto whole = static_cast<float>(cell);
        high = whole + part;
        low = part - (high - whole);
    }
};

// Whether samples of a tile are those of its terrain, moved by whole ones.
bool is_moved_only(const PlacedTile& tile, const geo::WrappedRows& rows) {
    constexpr double exact = 1 << 24;
    return tile.step == glm::dvec2(1.0) && tile.first == glm::floor(tile.first) &&
           glm::all(glm::lessThan(glm::abs(tile.first) + glm::dvec2(tile.tile->cells()),
                                  glm::dvec2(exact))) &&
           rows.wrap().rows() == 0;
}

// Hits on such a tile: as hit_in(), without what doubles round, and faster.
class MovedHits {
public:
    MovedHits(const PlacedTile& tile, const BlockRays& rays)
        : first_(tile.first), base_height_(rays.base_height), anchor_(tile.rays.anchor) {}

    [[nodiscard]] Hit at(const BlockHits& hits, std::size_t pixel) const {
        const SplitPlace col(hits.col[pixel] + first_.x, hits.col_part[pixel]);
        const SplitPlace row(hits.row[pixel] + first_.y, hits.row_part[pixel]);
        return {col.high,
                row.high,
                base_height_ + hits.height[pixel],
                static_cast<float>(anchor_ + hits.t[pixel]),
                col.low,
                row.low};
    }

private:
    glm::ivec2 first_;
    float base_height_;
    double anchor_;
};

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
          kernel_(block_kernel(options.target.value_or(SimdTarget{}).bit)) {
        std::ranges::transform(
            placed.tiles, std::back_inserter(are_moved_),
            [&](const PlacedTile& tile) { return is_moved_only(tile, placed.rows); });
    }

    void cast(const PixelBlock& block) const {
        std::vector<std::size_t> tiles;
        std::vector<BlockJob> jobs = block_jobs(placed_, block, options_.skips, &tiles);
        if (jobs.empty()) {
            for (int row = 0; row < block.size.y; ++row) {
                std::ranges::fill(row_of(block, row), Hit{});
            }
            return;
        }
        BlockHits found;
        kernel_.cast({jobs, placed_.has_walls}, found);
        if (jobs.size() == 1 && are_moved_[tiles.front()]) {
            const MovedHits moved(placed_.tiles[tiles.front()], jobs.front().rays);
            write(block, found, [&](std::size_t pixel) { return moved.at(found, pixel); });
        } else {
            write(block, found, [&](std::size_t pixel) {
                const auto job = static_cast<std::size_t>(found.job[pixel]);
                const PlacedTile& tile = placed_.tiles[tiles[job]];
                const BlockRays& rays = jobs[job].rays;
                return are_moved_[tiles[job]] ? MovedHits(tile, rays).at(found, pixel)
                                              : hit_in(found, tile, placed_.rows, rays, pixel);
            });
        }
    }

private:
    [[nodiscard]] std::span<Hit> row_of(const PixelBlock& block, int row) const {
        return hits_.row(block.first.y + row)
            .subspan(static_cast<std::size_t>(block.first.x),
                     static_cast<std::size_t>(block.size.x));
    }

    template <class HitAt>
    void write(const PixelBlock& block, const BlockHits& found, const HitAt& hit_at_pixel) const {
        for (int row = 0; row < block.size.y; ++row) {
            std::size_t pixel = static_cast<std::size_t>(row) * block_side;
            for (Hit& to : row_of(block, row)) {
                const bool is_hit = found.t[pixel] < std::numeric_limits<float>::infinity();
                to = is_hit ? hit_at_pixel(pixel) : Hit{};
                ++pixel;
            }
        }
    }

    const PlacedTiles& placed_;
    const CastOptions& options_;
    HitBuffer& hits_;
    BlockKernel kernel_;
    std::vector<bool> are_moved_; // of each tile
};

} // namespace

Result<HitBuffer> cast_hits(const PlacedTiles& placed, glm::ivec2 size,
                            const CastOptions& options) {
    HitBuffer hits = HitBuffer::unfilled(size.x, size.y);
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
