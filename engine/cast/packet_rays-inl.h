// Rays of a packet of pixels, one in each lane. Included once for each instruction set.
#if defined(RELJEF_PACKET_RAYS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELJEF_PACKET_RAYS_INL_H
#undef RELJEF_PACKET_RAYS_INL_H
#else
#define RELJEF_PACKET_RAYS_INL_H
#endif

#include <array>
#include <bit>

#include <hwy/highway.h>

#include "engine/cast/block_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace reljef::cast::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::CappedTag<float, 16>;
using IntTag = hn::RebindToSigned<FloatTag>;
using Floats = hn::Vec<FloatTag>;
using Ints = hn::Vec<IntTag>;
using Lanes = hn::Mask<FloatTag>;
using IntLanes = hn::Mask<IntTag>;
constexpr FloatTag floats{};
constexpr IntTag ints{};

constexpr int lane_count = static_cast<int>(hn::MaxLanes(floats));
constexpr int packet_cols = lane_count < beam_cols ? lane_count : beam_cols;
constexpr int packet_rows = lane_count / packet_cols;

HWY_INLINE Floats all(float value) {
    return hn::Set(floats, value);
}

// The beam of a pixel.
HWY_INLINE std::size_t beam_at(int col, int row) {
    return static_cast<std::size_t>(row / beam_rows * beams_a_row + col / beam_cols);
}

HWY_INLINE Ints all(std::int32_t value) {
    return hn::Set(ints, value);
}

HWY_INLINE Lanes no_lanes() {
    return hn::MaskFromVec(hn::Zero(floats));
}

// One axis of the ground: column or row.
struct Axis {
    Floats origin; // samples from the base
    Floats direction;
    Floats inverse;
    Floats origin_inverse; // origin · inverse
    Ints ahead;            // 1 where the ray moves to higher lines, else 0
    Floats base;           // of the samples
    std::int32_t last = 0; // cell

    // The t at which the ray crosses a line, counted from the base. Monotonic, and the same bits
    // for all cells at the line.
    [[nodiscard]] HWY_INLINE Floats time_at(Floats line) const {
        return hn::MulSub(line, inverse, origin_inverse);
    }
    [[nodiscard]] HWY_INLINE Floats at(Floats t) const { return hn::MulAdd(t, direction, origin); }
};

struct Rays {
    Axis col;
    Axis row;
    Floats height; // metres above the base height
    Floats rise;   // metres per t
    Floats begin;  // of t
    Floats end;
};

// A direction of 0 leaves no line; this one moves by less than rounding within any range of t.
HWY_INLINE Floats moving(Floats direction) {
    const Floats slowest = all(1e-25F);
    return hn::IfThenElse(hn::Lt(hn::Abs(direction), slowest), slowest, direction);
}

HWY_INLINE Axis axis_of(Floats origin, Floats direction, int base, int cells) {
    Axis axis;
    axis.origin = origin;
    axis.direction = moving(direction);
    axis.inverse = hn::Div(all(1.0F), axis.direction);
    axis.origin_inverse = hn::Mul(origin, axis.inverse);
    const Lanes forward = hn::Gt(axis.direction, hn::Zero(floats));
    axis.ahead = hn::IfThenElseZero(hn::RebindMask(ints, forward), all(1));
    axis.base = all(static_cast<float>(base));
    axis.last = cells - 1;
    return axis;
}

// Places of a packet's pixels, from the block's middle.
struct PixelOffsets {
    Floats right;
    Floats down;

    [[nodiscard]] HWY_INLINE Floats of(const BlockRays::Vectors& vectors, int component) const {
        return hn::MulAdd(
            down, all(vectors.down[component]),
            hn::MulAdd(right, all(vectors.right[component]), all(vectors.middle[component])));
    }
};

HWY_INLINE PixelOffsets offsets_of(int col, int row) {
    const Ints lane = hn::Iota(ints, 0);
    const Ints right = hn::And(lane, all(packet_cols - 1));
    const Ints down = hn::ShiftRight<std::countr_zero(static_cast<unsigned>(packet_cols))>(lane);
    const auto from_middle = [](Ints place, int first) HWY_ATTR {
        const float offset = static_cast<float>(first - block_side / 2) + 0.5F;
        return hn::Add(hn::ConvertTo(floats, place), all(offset));
    };
    return {from_middle(right, col), from_middle(down, row)};
}

// Where the ray leaves the tile.
HWY_INLINE Floats leaving_of(const Rays& rays, const BlockRays& block) {
    const auto leaving = [](const Axis& axis) HWY_ATTR {
        const Floats first = hn::Neg(axis.base);
        const Floats last = hn::Add(first, all(static_cast<float>(axis.last + 1)));
        return hn::Max(axis.time_at(first), axis.time_at(last));
    };
    return hn::Min(hn::Min(leaving(rays.col), leaving(rays.row)), all(block.end));
}

// Up to the border of the tile, or to the height beyond which nothing is hit.
HWY_INLINE Floats end_of(const Rays& rays, const BlockRays& block) {
    const Lanes rises = hn::Gt(rays.rise, hn::Zero(floats));
    const Floats height = hn::IfThenElse(rises, all(block.highest), all(block.lowest));
    const Floats past = hn::Div(hn::Sub(height, rays.height), moving(rays.rise));
    return hn::Min(leaving_of(rays, block), past);
}

// Where the ray comes over the tile.
struct Entry {
    Floats col; // t at which it crosses the first line
    Floats row;

    [[nodiscard]] HWY_INLINE Floats t() const { return hn::Max(col, row); }
};

HWY_INLINE Entry entry_of(const Rays& rays) {
    const auto entering = [](const Axis& axis) HWY_ATTR {
        const Floats first = hn::Neg(axis.base);
        const Floats last = hn::Add(first, all(static_cast<float>(axis.last + 1)));
        return hn::Min(axis.time_at(first), axis.time_at(last));
    };
    return {entering(rays.col), entering(rays.row)};
}

// The rays that come in from another tile.
HWY_INLINE Lanes walled_of(const Rays& rays, const Entry& entry, unsigned walls) {
    const auto has = [&](unsigned side) HWY_ATTR { return all((walls & side) != 0 ? 1.0F : 0.0F); };
    const auto side_of = [&](const Axis& axis, unsigned low, unsigned high) HWY_ATTR {
        const Lanes forward = hn::RebindMask(floats, hn::Eq(axis.ahead, all(1)));
        return hn::IfThenElse(forward, has(low), has(high));
    };
    const Floats side =
        hn::IfThenElse(hn::Ge(entry.col, entry.row), side_of(rays.col, west_wall, east_wall),
                       side_of(rays.row, north_wall, south_wall));
    return hn::And(hn::Gt(side, hn::Zero(floats)), hn::Gt(entry.t(), rays.begin));
}

HWY_INLINE Rays rays_of(const BlockJob& job, const PixelOffsets& pixels) {
    const BlockRays& block = job.rays;
    const auto axis = [&](int index) HWY_ATTR {
        return axis_of(pixels.of(block.origin, index), pixels.of(block.direction, index),
                       block.base[index], job.tile.cells[index]);
    };
    Rays rays;
    rays.col = axis(0);
    rays.row = axis(1);
    rays.height = pixels.of(block.origin, 2);
    rays.rise = pixels.of(block.direction, 2);
    rays.begin = all(block.begin);
    rays.end = end_of(rays, block);
    return rays;
}

} // namespace reljef::cast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
