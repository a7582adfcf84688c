// Rays of a packet of pixels, one in each lane, and the beams that find their starts. Included once
// for each instruction set.
#if defined(RELJEF_PACKET_RAYS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELJEF_PACKET_RAYS_INL_H
#undef RELJEF_PACKET_RAYS_INL_H
#else
#define RELJEF_PACKET_RAYS_INL_H
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "engine/cast/packet/block_kernel.h"
#include "engine/cast/packet/packet_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace reljef::cast::HWY_NAMESPACE {

constexpr int packet_cols = lane_count < beam_cols ? lane_count : beam_cols;
constexpr int packet_rows = lane_count / packet_cols;

// Packets walk in pairs: while one waits for heights, the other goes on. Loops over the packets of
// a walk are unrolled, so that registers hold their vectors.
constexpr std::size_t packets_a_pair = 2;
template <class T> using Pair = std::array<T, packets_a_pair>;

// The beam of a pixel.
HWY_INLINE std::size_t beam_at(int col, int row) {
    return static_cast<std::size_t>(row / beam_rows * beams_a_row + col / beam_cols);
}

// The bit of a pixel in BlockJob::beam_pixels.
HWY_INLINE unsigned beam_pixel_at(int col, int row) {
    return static_cast<unsigned>(row % beam_rows * beam_cols + col % beam_cols);
}

// Where the rays of a packet may begin; infinity: they hit nothing. Its first pixel is (col, row).
HWY_INLINE Floats starts_of(const BlockJob& job, int col, int row) {
    const Floats start = all(job.starts[beam_at(col, row)]);
    if (job.beam_pixels == whole_beam) {
        return start;
    }
    const unsigned bits = job.beam_pixels >> beam_pixel_at(col, row);
    const std::array<std::uint8_t, 8> bytes{static_cast<std::uint8_t>(bits & 0xFFU),
                                            static_cast<std::uint8_t>(bits >> 8U)};
    return hn::IfThenElse(hn::LoadMaskBits(floats, bytes.data()), start,
                          all(std::numeric_limits<float>::infinity()));
}

// How rays walk: whether a terrain has walls between its tiles, and whether work is counted.
struct InMemory {
    static constexpr bool has_walls = false;
    static constexpr bool counts = false;
};
struct AmongTiles {
    static constexpr bool has_walls = true;
    static constexpr bool counts = false;
};
struct Counted { // finds the hits of both
    static constexpr bool has_walls = true;
    static constexpr bool counts = true;
};

// What each ray costs, see BlockWork. Stays 0 unless work is counted.
struct Work {
    Ints taps;
    Ints steps;
    Ints rays;

    HWY_INLINE static Work nothing() { return {hn::Zero(ints), hn::Zero(ints), hn::Zero(ints)}; }
    HWY_INLINE void step(Lanes lanes, int taps_of_step) {
        const IntLanes which = hn::RebindMask(ints, lanes);
        taps = hn::Add(taps, hn::IfThenElseZero(which, all(taps_of_step)));
        steps = hn::Add(steps, hn::IfThenElseZero(which, all(std::int32_t{1})));
    }
    HWY_INLINE void tap(Lanes lanes, int count) {
        taps = hn::Add(taps, hn::IfThenElseZero(hn::RebindMask(ints, lanes), all(count)));
    }
    HWY_INLINE void begin(Lanes lanes) {
        const Ints one = hn::IfThenElseZero(hn::RebindMask(ints, lanes), all(std::int32_t{1}));
        rays = hn::Add(rays, one);
    }
};

// What the rays of a packet have met in nearer tiles.
struct Met {
    Lanes found;
    Lanes below; // the surface at the end of the last tile
    Work work;
    bool has_walls = true; // of the terrain; where work is counted

    HWY_INLINE static Met nothing() { return {no_lanes(), no_lanes(), Work::nothing()}; }
};

// One axis of the ground: column or row.
struct Axis {
    Floats origin; // samples from the base
    Floats direction;
    Floats inverse;
    Floats origin_inverse; // origin · inverse
    Floats ahead;          // 1 where the ray moves to higher lines, else 0
    Floats stride;         // 1 there, else -1
    Floats base;           // of the samples
    std::int32_t last = 0; // cell

    // The t at which the ray crosses a line, counted from the base. Monotonic, and the same bits
    // for all cells at the line.
    [[nodiscard]] HWY_INLINE Floats time_at(Floats line) const {
        return hn::MulSub(line, inverse, origin_inverse);
    }
    [[nodiscard]] HWY_INLINE Floats at(Floats t) const { return hn::MulAdd(t, direction, origin); }

    // The cell, counted from the base, that the ray leaves at a line.
    [[nodiscard]] HWY_INLINE Floats cell_before(Floats line) const { return hn::Sub(line, ahead); }
    [[nodiscard]] HWY_INLINE Ints index_of(Floats cell) const {
        return truncated(hn::Add(cell, base));
    }
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
    axis.ahead = hn::IfThenElseZero(forward, all(1.0F));
    axis.stride = hn::IfThenElse(forward, all(1.0F), all(-1.0F));
    axis.base = all(static_cast<float>(base));
    axis.last = cells - 1;
    return axis;
}

// Places of a packet's pixels, from the block's middle.
struct PixelOffsets {
    Floats right;
    Floats down;

    [[nodiscard]] HWY_INLINE Floats of(const BlockRays::Vectors& vectors, int component) const {
        const Floats linear = hn::MulAdd(
            down, all(vectors.down[component]),
            hn::MulAdd(right, all(vectors.right[component]), all(vectors.middle[component])));
        return vectors.is_bent ? hn::Add(linear, bend_of(vectors, component)) : linear;
    }

private:
    [[nodiscard]] HWY_INLINE Floats bend_of(const BlockRays::Vectors& vectors,
                                            int component) const {
        const auto factor = [&](std::size_t i)
                                HWY_ATTR { return all(vectors.bends[i][component]); };
        const Floats by_right = hn::MulAdd(right, factor(0), hn::Mul(down, factor(1)));
        return hn::MulAdd(right, by_right, hn::Mul(hn::Mul(down, down), factor(2)));
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
    const Floats rise = moving(rays.rise); // of level rays, too
    const Lanes rises = hn::Gt(rise, hn::Zero(floats));
    const Floats height = hn::IfThenElse(rises, all(block.highest), all(block.lowest));
    const Floats past = hn::Div(hn::Sub(height, rays.height), rise);
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

// The rays that come in from another tile, above the lowest one. `begin`: their t.
HWY_INLINE Lanes walled_of(const Rays& rays, const Entry& entry, Floats begin,
                           const BlockJob& job) {
    const unsigned walls = job.walls;
    const auto has = [&](unsigned side) HWY_ATTR { return all((walls & side) != 0 ? 1.0F : 0.0F); };
    const auto side_of = [&](const Axis& axis, unsigned low, unsigned high) HWY_ATTR {
        const Lanes forward = hn::Gt(axis.ahead, hn::Zero(floats));
        return hn::IfThenElse(forward, has(low), has(high));
    };
    const Floats side =
        hn::IfThenElse(hn::Ge(entry.col, entry.row), side_of(rays.col, west_wall, east_wall),
                       side_of(rays.row, north_wall, south_wall));
    const Lanes enters = hn::Gt(entry.t(), rays.begin);
    const Lanes walled = hn::And(hn::Gt(side, hn::Zero(floats)), enters);
    const Floats height = hn::MulAdd(begin, rays.rise, rays.height);
    const Lanes above = hn::Ge(height, all(job.wall_floor));
    return hn::And(above, (walls & begin_wall) != 0 ? hn::Or(walled, hn::Not(enters)) : walled);
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

HWY_INLINE Pair<Rays> rays_of(const BlockJob& job, const Pair<PixelOffsets>& pixels) {
    return {rays_of(job, pixels[0]), rays_of(job, pixels[1])};
}

// Floats have errors of 2^-24 of the distance from the rays' base, and a beam adds a few of them.
constexpr float beam_rounding = 0x1p-20F;

// A bound of all rays of each beam along an axis: first + t · change, for t >= 0.
struct BeamSide {
    Floats first;
    Floats change;

    [[nodiscard]] HWY_INLINE Floats at(Floats t) const { return hn::MulAdd(t, change, first); }
};

struct BeamAxis {
    BeamSide low;
    BeamSide high;
};

// The size of beams, which are numbered row after row in a block.
struct BeamSize {
    int cols; // pixels
    int rows;
    // Half their extent:
    glm::vec3 BlockRays::Vectors::*half;
};
constexpr BeamSize narrow_beams{beam_cols, beam_rows, &BlockRays::Vectors::half_beam};
constexpr BeamSize wide_beams{beam_cols, wide_beam_rows, &BlockRays::Vectors::half_wide_beam};

HWY_INLINE BeamAxis beam_axis(const BlockRays& block, const PixelOffsets& middles, BeamSize size,
                              int axis) {
    const Floats origin = middles.of(block.origin, axis);
    const Floats direction = middles.of(block.direction, axis);
    const Floats wider = all((block.origin.*size.half)[axis]);
    const Floats opening = all((block.direction.*size.half)[axis]);
    return {{hn::Sub(origin, wider), hn::Sub(direction, opening)},
            {hn::Add(origin, wider), hn::Add(direction, opening)}};
}

struct Beams {
    BeamAxis col;
    BeamAxis row;
    BeamSide height;
    float per_sample = 0.0F; // t in which no ray moves farther than a sample
};

// The beams from number `first` on.
HWY_INLINE Beams beams_of(const BlockRays& block, BeamSize size, int first) {
    const Ints number = hn::Iota(ints, first);
    const auto middle = [](Ints index, int pixels) HWY_ATTR {
        const float half = 0.5F * static_cast<float>(pixels - block_side);
        return hn::MulAdd(hn::ConvertTo(floats, index), all(static_cast<float>(pixels)), all(half));
    };
    const PixelOffsets middles{
        middle(hn::And(number, all(beams_a_row - 1)), size.cols),
        middle(hn::ShiftRight<std::countr_zero(static_cast<unsigned>(beams_a_row))>(number),
               size.rows)};
    constexpr float slowest = 1e-25F;
    return {beam_axis(block, middles, size, 0), beam_axis(block, middles, size, 1),
            beam_axis(block, middles, size, 2).low, 1.0F / std::max(block.speed, slowest)};
}

// Bounds of the cells that the beams may touch, and of their heights, on a piece of their way.
struct BeamPiece {
    Floats low_col; // from the base
    Floats high_col;
    Floats low_row;
    Floats high_row;
    Floats lowest; // metres above the base height
};

HWY_INLINE BeamPiece beam_piece(const Beams& beams, Floats begin, Floats end) {
    // Samples by which rounded rays may miss their place.
    const Floats margin = hn::MulAdd(hn::Abs(end), all(beam_rounding / beams.per_sample),
                                     all(beam_rounding * static_cast<float>(block_side)));
    const auto low = [&](const BeamSide& side)
                         HWY_ATTR { return hn::Min(side.at(begin), side.at(end)); };
    const auto high = [&](const BeamSide& side)
                          HWY_ATTR { return hn::Max(side.at(begin), side.at(end)); };
    return {hn::Sub(low(beams.col.low), margin), hn::Add(high(beams.col.high), margin),
            hn::Sub(low(beams.row.low), margin), hn::Add(high(beams.row.high), margin),
            low(beams.height)};
}

HWY_INLINE Ints cell_inside(Floats place, int base, int cells) {
    const float first = static_cast<float>(-base);
    const Floats inside =
        hn::Min(hn::Max(place, all(first)), all(first + static_cast<float>(cells - 1)));
    return hn::Add(truncated(hn::Floor(inside)), all(base));
}

// The highest height over the cells of a piece: of the at most four blocks that cover them.
// Infinity where more would.
HWY_INLINE Floats max_under(const BlockJob& job, const BeamPiece& piece) {
    const TileSamples& tile = job.tile;
    const glm::ivec2 base = job.rays.base;
    const Ints first_col = cell_inside(piece.low_col, base.x, tile.cells.x);
    const Ints last_col = cell_inside(piece.high_col, base.x, tile.cells.x);
    const Ints first_row = cell_inside(piece.low_row, base.y, tile.cells.y);
    const Ints last_row = cell_inside(piece.high_row, base.y, tile.cells.y);
    const Ints extent = hn::Max(hn::Sub(last_col, first_col), hn::Sub(last_row, first_row));
    // The exponent of a float is the number of bits, less one.
    const Ints bits = hn::BitCast(ints, hn::ConvertTo(floats, extent));
    const Ints level = hn::Max(hn::Sub(hn::ShiftRight<23>(bits), all(126)), hn::Zero(ints));
    const Ints coarse = hn::Min(level, all(tile.top_level));
    const Ints all_rows = all(2 * tile.rows);
    const Ints level_row = hn::Sub(all_rows, hn::Shr(all_rows, coarse));
    const Ints stride = all(tile.stride);
    const Ints north = hn::Mul(hn::Add(hn::Shr(first_row, coarse), level_row), stride);
    const Ints south = hn::Mul(hn::Add(hn::Shr(last_row, coarse), level_row), stride);
    const Ints west = hn::Shr(first_col, coarse);
    const Ints east = hn::Shr(last_col, coarse);
    const auto at = [&](Ints row, Ints col) HWY_ATTR {
        return hn::GatherIndex(floats, tile.maxima, hn::Add(row, col));
    };
    const Floats highest = hn::Max(hn::Max(at(north, west), at(north, east)),
                                   hn::Max(at(south, west), at(south, east)));
    const Lanes fits = hn::RebindMask(floats, hn::Eq(level, coarse));
    return hn::IfThenElse(fits, highest, all(std::numeric_limits<float>::infinity()));
}

// Beams that have left the tile, or are above all of it and rise.
HWY_INLINE Lanes beams_gone(const BlockJob& job, const Beams& beams, const BeamPiece& piece) {
    const Floats zero = hn::Zero(floats);
    const auto beyond = [&](const BeamAxis& axis, Floats low, Floats high, int index) HWY_ATTR {
        const float first = static_cast<float>(-job.rays.base[index]);
        const float last = first + static_cast<float>(job.tile.cells[index]);
        return hn::Or(hn::And(hn::Lt(high, all(first)), hn::Le(axis.high.change, zero)),
                      hn::And(hn::Gt(low, all(last)), hn::Ge(axis.low.change, zero)));
    };
    const Lanes above =
        hn::And(hn::Gt(piece.lowest, all(job.rays.highest)), hn::Ge(beams.height.change, zero));
    return hn::Or(above, hn::Or(beyond(beams.col, piece.low_col, piece.high_col, 0),
                                beyond(beams.row, piece.low_row, piece.high_row, 1)));
}

// Half the width of the beams at t, samples; at least half a sample.
HWY_INLINE Floats smallest_step(const Beams& beams, Floats t) {
    const auto width = [&](const BeamAxis& axis)
                           HWY_ATTR { return hn::Sub(axis.high.at(t), axis.low.at(t)); };
    const Floats half = all(0.5F);
    return hn::Max(hn::Mul(hn::Max(width(beams.col), width(beams.row)), half), half);
}

// Steps on as long as nothing can be hit; steps double in free space, and halve where a beam may
// hit, down to half its width. Infinity for beams that hit nothing. Adds its taps.
HWY_INLINE Floats clear_until(const BlockJob& job, const Beams& beams, Floats start,
                              std::size_t& taps) {
    constexpr std::size_t taps_of_step = 4;
    constexpr int max_steps = 48;
    constexpr float first_step = 4.0F; // samples
    const Floats bound = all(job.rays.base_height - 2.0F * job.rays.lift);
    const Floats never = all(std::numeric_limits<float>::infinity());
    Floats t = start;
    Floats step = all(first_step);
    Lanes active = hn::Lt(start, never);
    for (int i = 0; i < max_steps && !hn::AllFalse(floats, active); ++i) {
        taps += taps_of_step * hn::CountTrue(floats, active);
        const Floats end = hn::MulAdd(step, all(beams.per_sample), t);
        const BeamPiece piece = beam_piece(beams, t, end);
        const Lanes gone = hn::And(active, beams_gone(job, beams, piece));
        const Lanes clear =
            hn::And(active, hn::Gt(hn::Add(piece.lowest, bound), max_under(job, piece)));
        const Lanes blocked = hn::AndNot(clear, active);
        t = hn::IfThenElse(gone, never, hn::IfThenElse(clear, end, t));
        step = hn::Mul(step, hn::IfThenElse(clear, all(2.0F), all(0.5F)));
        const Lanes near = hn::And(blocked, hn::Lt(step, smallest_step(beams, t)));
        active = hn::AndNot(hn::Or(near, gone), active);
    }
    const Floats before = hn::NegMulAdd(all(beam_rounding), hn::Abs(t), t);
    return hn::IfThenElse(hn::Lt(t, never), hn::Max(before, start), never);
}

// The wide beams that hold the beams from number `first` on.
HWY_INLINE Ints wide_beam_at(int first) {
    constexpr auto cols = static_cast<unsigned>(beams_a_row);
    constexpr int in_wide = wide_beam_rows / beam_rows;
    const Ints number = hn::Iota(ints, first);
    const Ints row = hn::ShiftRight<std::countr_zero(cols * in_wide)>(number);
    return hn::Add(hn::ShiftLeft<std::countr_zero(cols)>(row),
                   hn::And(number, all(beams_a_row - 1)));
}

// `starts`: one for each beam of the size, from number `begin` to before `end`.
template <std::size_t count, class StartAt>
HWY_INLINE void find_starts_of(BlockJob& job, const BeamSize& size, int begin, int end,
                               const StartAt& start_at, std::array<float, count>& starts) {
    for (int first = begin; first < end; first += lane_count) {
        const Beams beams = beams_of(job.rays, size, first);
        hn::StoreU(clear_until(job, beams, start_at(first), job.beam_taps), floats,
                   starts.data() + first);
    }
}

// Finds the starts of the beams in a row of wide ones, from those on.
HWY_NOINLINE void find_row_of_starts(BlockJob& job, int row) {
    constexpr int beams = beam_count / rows_of_wide_beams;
    static_assert(beams % lane_count == 0 && wide_beam_count % lane_count == 0);
    if (job.found_starts == 0) {
        find_starts_of(
            job, wide_beams, 0, wide_beam_count,
            [&](int /*first*/) HWY_ATTR { return all(job.start); }, job.wide_starts);
    }
    job.found_starts |= 1U << static_cast<unsigned>(row);
    const auto wide_start = [&](int first) HWY_ATTR {
        return hn::GatherIndex(floats, job.wide_starts.data(), wide_beam_at(first));
    };
    find_starts_of(job, narrow_beams, row * beams, (row + 1) * beams, wide_start, job.starts);
}

// Finds the starts in these rows of wide beams (bits), unless they are found.
HWY_INLINE void find_starts(BlockJob& job, unsigned rows) {
    unsigned missing = rows & ~job.found_starts;
    if (missing != 0 && (!job.has_beams || !(job.start < std::numeric_limits<float>::infinity()))) {
        job.starts.fill(job.start);
        job.found_starts = all_wide_beams;
        return;
    }
    for (; missing != 0; missing &= missing - 1) {
        find_row_of_starts(job, std::countr_zero(missing));
    }
}

} // namespace reljef::cast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
