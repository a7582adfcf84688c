// The first hits of packets of rays. Included once for each instruction set.
#if defined(RELJEF_PACKET_WALK_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELJEF_PACKET_WALK_INL_H
#undef RELJEF_PACKET_WALK_INL_H
#else
#define RELJEF_PACKET_WALK_INL_H
#endif

#include "engine/cast/packet/packet_cells-inl.h"

HWY_BEFORE_NAMESPACE();
namespace reljef::cast::HWY_NAMESPACE {

// The cell of each ray, by the lines at which the ray may leave it. The ray enters the cell at t,
// or begins inside of it.
struct Walk {
    Floats t;
    Floats col_line; // from the base
    Floats row_line;
    Lanes active;  // not hit, not at the end
    Lanes arrived; // in a cell that it may hit
    // Only among tiles with walls:
    Floats entry; // t at which it comes in
    Lanes walled; // from another tile
    Lanes below;  // was below the surface where it was last
    Lanes wall;   // hit a wall
    Work work;
};

// The line at which a ray leaves the cell where it is at t: that of its place, corrected by the t
// of the cell's lines.
HWY_INLINE Floats line_after(const Axis& axis, Floats t) {
    const Floats first = hn::Neg(axis.base);
    const Floats last = hn::Add(first, all(static_cast<float>(axis.last)));
    const auto inside = [&](Floats cell) HWY_ATTR { return hn::Min(hn::Max(cell, first), last); };
    const Floats cell = inside(hn::Floor(axis.at(t)));
    const Floats line = hn::Add(cell, axis.ahead);
    const Floats entering = axis.time_at(hn::Sub(line, axis.stride));
    const Floats leaving = axis.time_at(line);
    const Floats back = hn::IfThenElseZero(hn::Lt(t, entering), axis.stride);
    const Floats onward = hn::IfThenElseZero(hn::Ge(t, leaving), axis.stride);
    return hn::Add(inside(hn::Add(hn::Sub(cell, back), onward)), axis.ahead);
}

HWY_INLINE Walk walk_from(const Rays& rays, Floats start) {
    Walk walk;
    walk.active = hn::Lt(start, rays.end);
    walk.arrived = no_lanes();
    walk.wall = no_lanes();
    walk.work = Work::nothing();
    walk.t = hn::IfThenElse(walk.active, start, rays.begin);
    walk.col_line = line_after(rays.col, walk.t);
    walk.row_line = line_after(rays.row, walk.t);
    return walk;
}

// A line between blocks of cells that a ray crosses next, along one axis.
struct NextLine {
    Floats line; // from the base
    Floats t;
    Floats stride; // to the line behind

    HWY_INLINE void pass(const Axis& axis, Lanes lanes) {
        line = hn::IfThenElse(lanes, hn::Add(line, stride), line); // with AVX-512 one addition
        t = axis.time_at(line);
    }
};

// The block of a level that a ray leaves next, along one axis.
struct NextBlock {
    Ints index;
    NextLine next;
};

// `cell_line`: at which it leaves a cell of the block.
HWY_INLINE NextBlock next_block(const Axis& axis, Floats cell_line, int level) {
    NextBlock block;
    const Ints cell = axis.index_of(axis.cell_before(cell_line));
    if (level == 0) {
        block.index = cell;
        block.next = {cell_line, axis.time_at(cell_line), axis.stride};
        return block;
    }
    const Floats cells = all(static_cast<float>(1 << level));
    block.index = hn::ShiftRightSame(cell, level);
    block.next.line =
        hn::MulSub(hn::Add(hn::ConvertTo(floats, block.index), axis.ahead), cells, axis.base);
    block.next.t = axis.time_at(block.next.line);
    block.next.stride = hn::Mul(axis.stride, cells);
    return block;
}

// The elements of the blocks of a level in TileSamples::maxima.
struct BlockPlaces {
    Ints index;
    Ints col_stride; // to the next block of each ray
    Ints row_stride;

    HWY_INLINE void move(Lanes sideways) {
        const IntLanes to_side = hn::RebindMask(ints, sideways);
        index = hn::IfThenElse(to_side, hn::Add(index, col_stride), index);
        index = hn::IfThenElse(to_side, index, hn::Add(index, row_stride));
    }
};

HWY_INLINE BlockPlaces places_of(const Rays& rays, const TileSamples& tile, Ints col, Ints row,
                                 int level) {
    const int first_row = 2 * tile.rows - ((2 * tile.rows) >> level);
    const Ints stride = all(tile.stride);
    const auto steps = [](const Axis& axis, int elements) HWY_ATTR {
        const Lanes forward = hn::Gt(axis.stride, hn::Zero(floats));
        return hn::IfThenElse(hn::RebindMask(ints, forward), all(elements), all(-elements));
    };
    return {hn::Add(hn::Mul(hn::Add(row, all(first_row)), stride), col), steps(rays.col, 1),
            steps(rays.row, tile.stride)};
}

// The last element of TileSamples::maxima.
HWY_INLINE Ints last_place_of(const TileSamples& tile) {
    const int rows = 2 * tile.rows - (tile.rows >> tile.top_level);
    return all(rows * tile.stride - 1);
}

// The heights at these places; anything for rays beyond the tile and for other lanes.
HWY_INLINE Floats maxima_at(const float* maxima, Ints places, Ints last, Lanes lanes) {
    const hn::RebindToUnsigned<IntTag> unsigned_ints;
    const auto inside =
        hn::Min(hn::BitCast(unsigned_ints, places), hn::BitCast(unsigned_ints, last));
    return gather(maxima, hn::BitCast(ints, inside), lanes);
}

// A packet on its way from block to block of a level while its rays are above them. No step waits
// for the maxima of the one before: rays that have arrived at a block that they may hit go on, and
// their last lines are kept. Rays that have left the tile go on, too: end() ends them.
template <class Mode> struct March {
    NextLine col;
    NextLine row;
    BlockPlaces places;
    Ints last_place;
    const float* maxima;
    Floats kept_col; // the next line of a ray when it was last on its way
    Floats kept_row;
    Floats height; // of the rays over the lifted maxima, at t = 0
    Floats enter_height;
    Lanes lanes;
    Lanes run;
    Floats first_col; // the first lines; only among tiles with walls
    Floats first_row;
    Floats entered; // t at which a ray entered its block; only where work is counted

    HWY_INLINE static March start(const Rays& rays, const BlockJob& job, int level,
                                  const Walk& walk) {
        const NextBlock col = next_block(rays.col, walk.col_line, level);
        const NextBlock row = next_block(rays.row, walk.row_line, level);
        const float lift = job.skips_cells ? job.rays.lift : std::numeric_limits<float>::infinity();
        March march;
        march.lanes = hn::AndNot(walk.arrived, walk.active);
        march.run = march.lanes;
        march.col = col.next;
        march.row = row.next;
        march.places = places_of(rays, job.tile, col.index, row.index, level);
        march.last_place = last_place_of(job.tile);
        march.maxima = job.tile.maxima;
        march.kept_col = march.col.line;
        march.kept_row = march.row.line;
        march.first_col = march.col.line;
        march.first_row = march.row.line;
        march.height = hn::Add(rays.height, all(job.rays.base_height - lift));
        march.enter_height = hn::MulAdd(walk.t, rays.rise, march.height);
        march.entered = walk.t;
        return march;
    }

    HWY_INLINE void step(const Rays& rays, Walk& walk) {
        const Floats next = hn::Min(col.t, row.t);
        const Floats leave_height = hn::MulAdd(next, rays.rise, height);
        const Floats highest = maxima_at(maxima, places.index, last_place, lanes);
        if constexpr (Mode::counts) {
            walk.work.step(hn::And(run, hn::Lt(entered, rays.end)), 1);
            entered = next;
        }
        run = and_greater(run, hn::Min(enter_height, leave_height), highest);
        const Lanes sideways = hn::Le(col.t, row.t);
        col.pass(rays.col, sideways);
        row.pass(rays.row, hn::Not(sideways));
        places.move(sideways);
        enter_height = leave_height;
        kept_col = hn::IfThenElse(run, col.line, kept_col);
        kept_row = hn::IfThenElse(run, row.line, kept_row);
    }

    HWY_INLINE void end(const Rays& rays, int level, Walk& walk) const {
        const Floats entering = hn::Max(rays.col.time_at(hn::Sub(kept_col, col.stride)),
                                        rays.row.time_at(hn::Sub(kept_row, row.stride)));
        walk.t = hn::IfThenElse(lanes, hn::Max(walk.t, entering), walk.t);
        const Lanes there = hn::And(lanes, hn::Lt(walk.t, rays.end));
        walk.active = hn::Or(there, hn::AndNot(lanes, walk.active));
        if constexpr (Mode::has_walls) {
            const Lanes moved =
                hn::Or(hn::Ne(kept_col, first_col), hn::Ne(kept_row, first_row)); // above a block
            walk.below = hn::AndNot(hn::And(lanes, moved), walk.below);
        }
        if (level == 0) {
            walk.arrived = hn::Or(walk.arrived, hn::AndNot(run, there));
            walk.col_line = hn::IfThenElse(lanes, kept_col, walk.col_line);
            walk.row_line = hn::IfThenElse(lanes, kept_row, walk.row_line);
        } else {
            walk.col_line = hn::IfThenElse(lanes, line_after(rays.col, walk.t), walk.col_line);
            walk.row_line = hn::IfThenElse(lanes, line_after(rays.row, walk.t), walk.row_line);
        }
    }
};

// Whether any lane of any packet is set.
template <auto lanes, class T, std::size_t count>
HWY_INLINE bool is_any(const std::array<T, count>& packets) {
    Lanes any = packets[0].*lanes;
#pragma GCC unroll 2
    for (std::size_t k = 1; k < count; ++k) {
        any = hn::Or(any, packets[k].*lanes);
    }
    return !hn::AllFalse(floats, any);
}

// Moves rays from block to block of a level while they are above them, at most `max_steps` times.
template <class Mode, std::size_t count>
HWY_INLINE void march(const std::array<Rays, count>& rays, const BlockJob& job, int level,
                      int max_steps, std::array<Walk, count>& walks) {
    std::array<March<Mode>, count> marches;
#pragma GCC unroll 2
    for (std::size_t k = 0; k < count; ++k) {
        marches[k] = March<Mode>::start(rays[k], job, level, walks[k]);
    }
    for (int i = 0; i < max_steps && is_any<&March<Mode>::run>(marches); ++i) {
#pragma GCC unroll 2
        for (std::size_t k = 0; k < count; ++k) {
            marches[k].step(rays[k], walks[k]);
        }
    }
#pragma GCC unroll 2
    for (std::size_t k = 0; k < count; ++k) {
        marches[k].end(rays[k], level, walks[k]);
    }
}

// The rays that come in below the surface and were above it before. Notes for those that miss on
// which side they leave their cells.
HWY_INLINE Lanes hit_walls(const Piece& piece, Lanes crossing, Walk& walk) {
    const Floats zero = hn::Zero(floats);
    const Lanes comes_in = hn::And(walk.walled, hn::Eq(piece.begin, walk.entry));
    const Lanes was_above = hn::AndNot(walk.below, walk.arrived);
    const Lanes wall = hn::And(hn::And(comes_in, was_above), hn::Lt(piece.start, zero));
    walk.wall = hn::Or(walk.wall, wall);
    const Lanes missed = hn::AndNot(hn::Or(wall, crossing), walk.arrived);
    walk.below =
        hn::Or(hn::And(missed, hn::Lt(piece.finish, zero)), hn::AndNot(missed, walk.below));
    return wall;
}

// Moves rays that miss their cells into the next ones.
HWY_INLINE void pass_cells(const Rays& rays, const CellLines& lines, Lanes missed, Walk& walk) {
    const Lanes sideways = hn::Le(lines.col.leaving, lines.row.leaving);
    const auto move = [](const Axis& axis, Lanes lanes, Floats& line) HWY_ATTR {
        line = hn::IfThenElse(lanes, hn::Add(line, axis.stride), line);
    };
    move(rays.col, hn::And(missed, sideways), walk.col_line);
    move(rays.row, hn::AndNot(sideways, missed), walk.row_line);
    walk.t = hn::IfThenElse(missed, hn::Min(lines.col.leaving, lines.row.leaving), walk.t);
    walk.active = hn::AndNot(hn::And(missed, hn::Ge(walk.t, rays.end)), walk.active);
}

// Ends the rays that hit their cells.
template <class Mode>
HWY_INLINE Lanes solve(const Rays& rays, const BlockJob& job, Walk& walk, HitPieces& pieces) {
    const CellLines lines{lines_of(rays.col, walk.col_line), lines_of(rays.row, walk.row_line)};
    const IntLanes there = hn::RebindMask(ints, walk.arrived);
    const Corners corners =
        corners_of(job, hn::IfThenElseZero(there, rays.col.index_of(lines.col.cell)),
                   hn::IfThenElseZero(there, rays.row.index_of(lines.row.cell)));
    const Piece piece = piece_in(rays, corners, lines);
    if constexpr (Mode::counts) {
        constexpr int corner_count = 4;
        walk.work.step(walk.arrived, corner_count);
    }
    Lanes hit = hn::And(crosses(piece), walk.arrived);
    if constexpr (Mode::has_walls) {
        hit = hn::Or(hit, hit_walls(piece, hit, walk));
    }
    pieces.keep(piece, corners, hit);
    walk.active = hn::AndNot(hit, walk.active);
    pass_cells(rays, lines, hn::AndNot(hit, walk.arrived), walk);
    walk.arrived = no_lanes();
    return hit;
}

// Whether cells are solved: when three quarters of the rays that are left have arrived at one.
template <std::size_t count>
HWY_INLINE bool is_time_to_solve(const std::array<Walk, count>& walks) {
    std::size_t arrived = 0;
    std::size_t left = 0;
#pragma GCC unroll 2
    for (const Walk& walk : walks) {
        arrived += hn::CountTrue(floats, walk.arrived);
        left += hn::CountTrue(floats, walk.active);
    }
    return 4 * arrived >= 3 * left;
}

// Walks all rays to their first hit: through ever larger blocks as long as rays find none that they
// may hit.
template <class Mode, std::size_t count>
HWY_INLINE std::array<Lanes, count> find_hits(const std::array<Rays, count>& rays,
                                              const BlockJob& job, std::array<Walk, count>& moved,
                                              std::array<HitPieces, count>& pieces) {
    std::array<Walk, count> walks = moved; // a copy, whose vectors registers may hold
    constexpr int levels = 2;              // between marches
    constexpr int max_steps = 24;
    std::array<Lanes, count> hits;
    for (Lanes& lanes : hits) {
        lanes = no_lanes();
    }
    const int top_level = job.skips_blocks ? job.tile.top_level : 0;
    int top = 0; // a start is near the surface
    if constexpr (Mode::counts) {
        for (Walk& walk : walks) {
            walk.work.begin(walk.active);
        }
    }
    while (is_any<&Walk::active>(walks)) {
        for (int level = top; level > 0; level -= levels) {
            march<Mode, count>(rays, job, level, max_steps, walks);
        }
        march<Mode, count>(rays, job, 0, max_steps, walks);
        top = top + levels <= top_level ? top + levels : top;
        if (is_time_to_solve(walks)) {
#pragma GCC unroll 2
            for (std::size_t k = 0; k < count; ++k) {
                hits[k] = hn::Or(hits[k], solve<Mode>(rays[k], job, walks[k], pieces[k]));
            }
            top = 0;
        }
    }
    moved = walks;
    return hits;
}

// The hits of a packet while the other one of its pair has no ray.
template <class Mode>
HWY_INLINE Lanes hits_alone(const Rays& rays, const BlockJob& job, Walk& walk, HitPieces& pieces) {
    std::array<Walk, 1> walks{walk};
    std::array<HitPieces, 1> kept;
    const std::array<Lanes, 1> hits = find_hits<Mode, 1>({rays}, job, walks, kept);
    walk = walks[0];
    pieces = kept[0];
    return hits[0];
}

// Among tiles, a packet is often alone: at their borders.
template <class Mode>
HWY_INLINE Pair<Lanes> pair_hits(const Pair<Rays>& rays, const BlockJob& job, Pair<Walk>& walks,
                                 Pair<HitPieces>& pieces) {
    const bool first = !hn::AllFalse(floats, walks[0].active);
    const bool second = !hn::AllFalse(floats, walks[1].active);
    if (!Mode::has_walls || (first && second)) {
        return find_hits<Mode, packets_a_pair>(rays, job, walks, pieces);
    }
    Pair<Lanes> hits{no_lanes(), no_lanes()};
    if (first || second) {
        const std::size_t k = first ? 0 : 1;
        hits[k] = hits_alone<Mode>(rays[k], job, walks[k], pieces[k]);
    }
    return hits;
}

// Where a packet's rays hit.
struct PacketHits {
    Lanes found;
    Ints col; // cell
    Ints row;
    Floats t;
    Floats col_part; // in the cell, [0, 1]
    Floats row_part;
    Floats height; // metres above the base height
    Corners corners;

    HWY_INLINE static PacketHits nothing() {
        const Floats zero = hn::Zero(floats);
        const Ints cell = hn::Zero(ints);
        return {no_lanes(), cell, cell, zero, zero, zero, zero, {zero, zero, zero, zero}};
    }
};

// The walk over a tile before its first step. Lets rays that begin below the tile go on to its
// border.
template <class Mode>
HWY_INLINE Walk walk_over(Rays& rays, const BlockJob& job, Floats start, const Met& met) {
    const Entry entry = entry_of(rays);
    const Floats begin = hn::Max(hn::Max(entry.t(), rays.begin), start);
    if (Mode::has_walls && (!Mode::counts || met.has_walls)) {
        // A ray that begins below all of the tile is past its surface, and may hit a wall.
        const Floats height = hn::MulAdd(begin, rays.rise, rays.height);
        rays.end = hn::IfThenElse(hn::Lt(height, all(job.rays.lowest)), leaving_of(rays, job.rays),
                                  rays.end);
    }
    Walk walk = walk_from(rays, begin);
    if constexpr (Mode::has_walls) {
        walk.active = hn::AndNot(met.found, walk.active);
        walk.entry = hn::Max(entry.t(), rays.begin);
        walk.walled = walled_of(rays, entry, begin, job);
        walk.below = met.below;
    }
    if constexpr (Mode::counts) {
        walk.work = met.work;
    }
    return walk;
}

// What a packet has met after its walk.
template <class Mode> HWY_INLINE void note_walk(Lanes found, const Walk& walk, Met& met) {
    met.found = hn::Or(met.found, found);
    if constexpr (Mode::has_walls) {
        met.below = walk.below;
    }
    if constexpr (Mode::counts) {
        met.work = walk.work;
    }
}

template <class Mode>
HWY_INLINE PacketHits hits_in(const HitPieces& pieces, Lanes found, const Rays& rays,
                              const Walk& walk) {
    PacketHits hits;
    hits.found = found;
    const auto cell = [&](const Axis& axis, Floats line) HWY_ATTR {
        return hn::IfThenElseZero(hn::RebindMask(ints, hits.found),
                                  axis.index_of(axis.cell_before(line)));
    };
    hits.col = cell(rays.col, walk.col_line);
    hits.row = cell(rays.row, walk.row_line);
    hits.corners = pieces.corners_of(hits.found);
    const Piece piece = pieces.piece_of(hits.found);
    Floats u = crossing_of(piece);
    if constexpr (Mode::has_walls) {
        u = hn::IfThenZeroElse(walk.wall, u);
    }
    hits.t = hn::MulAdd(u, hn::Sub(piece.end, piece.begin), piece.begin);
    hits.col_part = hn::MulAdd(u, piece.col.way, piece.col.enter);
    hits.row_part = hn::MulAdd(u, piece.row.way, piece.row.enter);
    hits.height = height_in(hits.corners, hits.col_part, hits.row_part);
    if constexpr (Mode::has_walls) {
        const Floats on_ray = hn::MulAdd(hits.t, rays.rise, rays.height);
        hits.height = hn::IfThenElse(walk.wall, on_ray, hits.height);
    }
    return hits;
}

// The first hits of the rays that have found nothing yet. `starts`: the t from which they may hit.
// From here on, rays that begin below the tile end at its border.
template <class Mode>
HWY_NOINLINE Pair<PacketHits> hits_of(Pair<Rays>& rays, const BlockJob& job,
                                      const Pair<Floats>& starts, Pair<Met>& met) {
    Pair<Walk> walks;
#pragma GCC unroll 2
    for (std::size_t k = 0; k < packets_a_pair; ++k) {
        walks[k] = walk_over<Mode>(rays[k], job, starts[k], met[k]);
    }
    Pair<HitPieces> pieces;
    if constexpr (lane_count == 1) {
        pieces = {}; // else g++ warns of lanes without a value
    }
    const Pair<Lanes> found = pair_hits<Mode>(rays, job, walks, pieces);
    Pair<PacketHits> hits;
#pragma GCC unroll 2
    for (std::size_t k = 0; k < packets_a_pair; ++k) {
        note_walk<Mode>(found[k], walks[k], met[k]);
        hits[k] = hn::AllFalse(floats, found[k])
                      ? PacketHits::nothing()
                      : hits_in<Mode>(pieces[k], found[k], rays[k], walks[k]);
    }
    return hits;
}

} // namespace reljef::cast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
