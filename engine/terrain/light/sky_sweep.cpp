#include "engine/terrain/light/sky_sweep.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

// As engine/cast/packet/block_kernel.cpp.
#define RELJEF_UNUSED_TARGETS                                                                      \
    (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#ifdef __SANITIZE_ADDRESS__ // two of them show the same errors
#define HWY_DISABLED_TARGETS (RELJEF_UNUSED_TARGETS | HWY_SSE4 | HWY_AVX3)
#else
#define HWY_DISABLED_TARGETS RELJEF_UNUSED_TARGETS
#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/terrain/light/sky_sweep.cpp"
#include <hwy/foreach_target.h>

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#ifndef RELJEF_SKY_SWEEP_ONCE
#define RELJEF_SKY_SWEEP_ONCE
namespace reljef::terrain {

constexpr int max_packs = 4;                         // of lines that are swept side by side
constexpr int max_lanes = max_sky_lines / max_packs; // of AVX-512

// By pack, step and lane.
struct SweepMemory {
    int packs = 0;
    std::span<float> heights;
    std::span<std::int32_t> before;
};

} // namespace reljef::terrain
#endif

HWY_BEFORE_NAMESPACE();
namespace reljef::terrain::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
constexpr hn::ScalableTag<float> floats;
constexpr hn::ScalableTag<std::int32_t> ints;
using Floats = hn::Vec<decltype(floats)>;
using Ints = hn::Vec<decltype(ints)>;
using FloatLanes = hn::Mask<decltype(floats)>;

static_assert(HWY_MAX_BYTES <= static_cast<std::size_t>(max_lanes) * sizeof(float));

HWY_INLINE int lane_count() {
    return static_cast<int>(hn::Lanes(floats));
}

HWY_INLINE std::size_t index(int i) {
    return static_cast<std::size_t>(i);
}

// The values at columns from `col` on, of which those outside of the row are 0.
HWY_INLINE Floats load(std::span<const float> row, int col) {
    const int cols = static_cast<int>(row.size());
    if (col >= 0 && col + lane_count() <= cols) {
        return hn::LoadU(floats, row.data() + col);
    }
    HWY_ALIGN float lanes[HWY_MAX_BYTES / sizeof(float)] = {};
    for (int i = std::max(-col, 0); i < std::min(lane_count(), cols - col); ++i) {
        lanes[i] = row[index(col + i)];
    }
    return hn::Load(floats, lanes);
}

HWY_INLINE void store(Floats values, std::span<float> row, int col) {
    const int cols = static_cast<int>(row.size());
    if (col >= 0 && col + lane_count() <= cols) {
        hn::StoreU(values, floats, row.data() + col);
        return;
    }
    HWY_ALIGN float lanes[HWY_MAX_BYTES / sizeof(float)];
    hn::Store(values, floats, lanes);
    for (int i = std::max(-col, 0); i < std::min(lane_count(), cols - col); ++i) {
        row[index(col + i)] = lanes[i];
    }
}

struct GroundPoint {
    Ints place; // step along the line; -1: none
    Floats height;
};

// In each lane the convex hull of the ground that its sweep has passed: each point knows the one
// before it, and the last two are at hand.
class Hulls {
public:
    // Memory for each step and lane.
    HWY_INLINE void use(float* heights, std::int32_t* before) {
        heights_ = heights;
        before_ = before;
    }

    HWY_INLINE void clear() {
        const GroundPoint none{hn::Set(ints, -1), hn::Zero(floats)};
        last_ = none;
        last_but_one_ = none;
    }

    // The height of the steepest rise from new points back to the ground over the steps to there,
    // at least 0; then adds the points of some lanes. `step`: that of the points.
    HWY_INLINE Floats add(int step, Floats height, FloatLanes lanes) {
        const GroundPoint point{hn::Set(ints, step), height};
        drop_hidden(point, lanes);
        const Floats slope = hn::IfThenElseZero(
            is_there(last_), hn::Div(hn::Sub(last_.height, height), steps_to(last_, point)));
        push(step, point, lanes);
        return hn::Max(slope, hn::Zero(floats));
    }

private:
    static HWY_INLINE FloatLanes is_there(const GroundPoint& point) {
        return hn::RebindMask(floats, hn::Gt(point.place, hn::Set(ints, -1)));
    }
    static HWY_INLINE Floats steps_to(const GroundPoint& behind, const GroundPoint& point) {
        return hn::ConvertTo(floats, hn::Sub(point.place, behind.place));
    }
    static HWY_INLINE GroundPoint chosen(FloatLanes lanes, const GroundPoint& a,
                                         const GroundPoint& b) {
        return {hn::IfThenElse(hn::RebindMask(ints, lanes), a.place, b.place),
                hn::IfThenElse(lanes, a.height, b.height)};
    }

    // The points to which the slope is no steeper than to the one before.
    HWY_INLINE void drop_hidden(const GroundPoint& point, FloatLanes lanes) {
        while (true) {
            const Floats to_last =
                hn::Mul(hn::Sub(last_.height, point.height), steps_to(last_but_one_, point));
            const Floats to_other =
                hn::Mul(hn::Sub(last_but_one_.height, point.height), steps_to(last_, point));
            const FloatLanes drops =
                hn::And(hn::And(lanes, is_there(last_but_one_)), hn::Le(to_last, to_other));
            if (hn::AllFalse(floats, drops)) {
                return;
            }
            last_ = chosen(drops, last_but_one_, last_);
            last_but_one_ = chosen(drops, before(last_), last_but_one_);
        }
    }

    // The points before others in the hulls.
    [[nodiscard]] HWY_INLINE GroundPoint before(const GroundPoint& point) const {
        const Ints zero = hn::Zero(ints);
        const Ints place = hn::GatherIndex(ints, before_, in_lanes(hn::Max(point.place, zero)));
        return {place, hn::GatherIndex(floats, heights_, in_lanes(hn::Max(place, zero)))};
    }

    HWY_INLINE void push(int step, const GroundPoint& point, FloatLanes lanes) {
        const std::size_t at = index(step) * hn::Lanes(floats);
        hn::StoreU(point.height, floats, heights_ + at);
        hn::StoreU(last_.place, ints, before_ + at);
        last_but_one_ = chosen(lanes, last_, last_but_one_);
        last_ = chosen(lanes, point, last_);
    }

    static HWY_INLINE Ints in_lanes(Ints places) {
        return hn::Add(hn::Mul(places, hn::Set(ints, lane_count())), hn::Iota(ints, 0));
    }

    float* heights_ = nullptr; // by step, then lane
    std::int32_t* before_ = nullptr;
    GroundPoint last_;
    GroundPoint last_but_one_;
};

// Neighbouring lines, one a lane.
struct Pack {
    int row = 0; // of the first steps
    int col = 0; // of the first lane's
};

// Sweeps a few packs side by side: each step is in other pages of the memory.
class PackSweeper {
public:
    PackSweeper(const SkySweep& sweep, const SweepMemory& memory, Grid<float>& share)
        : sweep_(sweep), share_(share), packs_(memory.packs) {
        const std::size_t size = index(steps_from(0)) * hn::Lanes(floats);
        for (int i = 0; i < packs_; ++i) {
            hulls_[i].use(memory.heights.data() + index(i) * size,
                          memory.before.data() + index(i) * size);
        }
    }

    [[nodiscard]] int width() const { return packs_ * lane_count(); }

    void sweep(Pack first) {
        const int steps = steps_from(first.row);
        int begin = 0;
        while (begin < steps && !reaches(first, begin)) {
            ++begin;
        }
        int end = begin;
        while (end < steps && reaches(first, end)) {
            ++end;
        }
        clear();
        for (int step = begin; step < end; ++step) {
            prefetch(first, step + steps_ahead);
            visit(first, step, step - begin);
        }
        clear();
        for (int step = end - 1; step >= begin; --step) {
            prefetch(first, step - steps_ahead);
            visit(first, step, end - 1 - step);
        }
    }

private:
    [[nodiscard]] int steps_from(int row) const {
        return (sweep_.heights.rows() - row + sweep_.step.y - 1) / sweep_.step.y;
    }
    [[nodiscard]] int row_at(Pack pack, int step) const { return pack.row + step * sweep_.step.y; }
    [[nodiscard]] int col_at(Pack pack, int step) const { return pack.col + step * sweep_.step.x; }
    [[nodiscard]] bool reaches(Pack pack, int step) const {
        const int col = col_at(pack, step);
        return col + width() > 0 && col < sweep_.heights.cols();
    }

    void clear() {
        for (int i = 0; i < packs_; ++i) {
            hulls_[i].clear();
        }
    }

    HWY_INLINE void prefetch(Pack first, int step) const {
        const int row = row_at(first, step);
        if (row < 0 || row >= sweep_.heights.rows()) {
            return;
        }
        for (int i = 0; i < packs_; ++i) {
            const int col =
                std::clamp(col_at(first, step) + i * lane_count(), 0, sweep_.heights.cols() - 1);
            hwy::Prefetch(sweep_.heights.row(row).data() + col);
            hwy::Prefetch(share_.row(row).data() + col);
        }
    }

    HWY_INLINE void visit(Pack first, int step, int place) {
        const std::span<const float> heights = sweep_.heights.row(row_at(first, step));
        const std::span<float> shares = share_.row(row_at(first, step));
        for (int i = 0; i < packs_; ++i) {
            const int col = col_at(first, step) + i * lane_count();
            const Floats slope =
                hn::Mul(hulls_[i].add(place, load(heights, col), lanes_inside(col)),
                        hn::Set(floats, sweep_.rise));
            const Floats light = hn::Div(hn::Set(floats, sweep_.weight),
                                         hn::Add(hn::Set(floats, 1.0F), hn::Mul(slope, slope)));
            store(hn::Add(load(shares, col), light), shares, col);
        }
    }

    [[nodiscard]] HWY_INLINE FloatLanes lanes_inside(int col) const {
        const Ints cols = hn::Iota(ints, col);
        const auto begun = hn::Gt(cols, hn::Set(ints, -1));
        return hn::RebindMask(floats,
                              hn::And(begun, hn::Lt(cols, hn::Set(ints, sweep_.heights.cols()))));
    }

    static constexpr int steps_ahead = 8;

    const SkySweep& sweep_;
    Grid<float>& share_;
    int packs_;
    Hulls hulls_[max_packs];
};

void sweep_lines(const SkySweep& sweep, const SkyLines& lines, const SweepMemory& memory,
                 Grid<float>& share) {
    PackSweeper sweeper(sweep, memory, share);
    for (int col = lines.first_col; col < lines.end_col; col += sweeper.width()) {
        sweeper.sweep({lines.row, col});
    }
}

} // namespace reljef::terrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace reljef::terrain {

HWY_EXPORT(sweep_lines);

void sweep_sky(const SkySweep& sweep, const SkyLines& lines, Grid<float>& share) {
    constexpr int long_line = 16384; // steps: its hulls take 2 MB in each pack
    const int steps = (sweep.heights.rows() + sweep.step.y - 1) / sweep.step.y;
    const int packs = steps > long_line ? 1 : max_packs;
    const std::size_t size =
        static_cast<std::size_t>(steps) * static_cast<std::size_t>(packs * max_lanes);
    std::vector<float> heights(size);
    std::vector<std::int32_t> before(size);
    HWY_DYNAMIC_DISPATCH(sweep_lines)(sweep, lines, {packs, heights, before}, share);
}

} // namespace reljef::terrain
#endif
