// The first hits of a packet of rays. Included once for each instruction set.
#if defined(RELJEF_PACKET_WALK_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELJEF_PACKET_WALK_INL_H
#undef RELJEF_PACKET_WALK_INL_H
#else
#define RELJEF_PACKET_WALK_INL_H
#endif

#include "engine/cast/packet/packet_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace reljef::cast::HWY_NAMESPACE {

// The piece of a ray over a cell, along one axis. Where the ray crosses the border, the place in
// the cell is exactly 0 or 1.
struct PieceAxis {
    Floats enter; // in the cell, [0, 1]
    Floats leave;
    Floats way; // leave − enter
};

// The piece of each ray over its cell, and the height of the ray above the cell's bilinear surface
// along it: start + slope · u + bend · u², u in [0, 1]. It depends on ray and cell alone. Two cells
// share the bits of the height at the border between them, so that no ray passes between.
struct Piece {
    Floats begin; // t
    Floats end;
    PieceAxis col;
    PieceAxis row;
    Floats start;
    Floats slope;
    Floats bend;
    Floats finish;
};

// A patch's corners, metres above the base height: exact for heights near it (Sterbenz).
struct Corners {
    Floats h00;
    Floats h10;
    Floats h01;
    Floats h11;
};

HWY_INLINE Corners corners_of(const BlockJob& job, Ints col, Ints row) {
    const Ints index = hn::Add(hn::Mul(row, all(job.tile.height_stride)), col);
    const float* const heights = job.tile.heights;
    const Floats base = all(job.rays.base_height);
    const auto north = load_neighbours(floats, heights, index);
    const auto south = load_neighbours(floats, heights + job.tile.height_stride, index);
    return {hn::Sub(north.first, base), hn::Sub(north.second, base), hn::Sub(south.first, base),
            hn::Sub(south.second, base)};
}

HWY_INLINE Floats height_in(const Corners& corners, Floats col_part, Floats row_part) {
    return mixed(mixed(corners.h00, corners.h01, row_part),
                 mixed(corners.h10, corners.h11, row_part), col_part);
}

// Lines of a cell, and the t at which the ray crosses them.
struct Lines {
    Floats cell; // from the base
    Floats ahead;
    Floats entering;
    Floats leaving;
};

HWY_INLINE Lines lines_of(const Axis& axis, Ints cell) {
    Lines lines;
    lines.cell = hn::Sub(hn::ConvertTo(floats, cell), axis.base);
    lines.ahead = hn::ConvertTo(floats, axis.ahead);
    const Floats near = hn::Sub(hn::Add(lines.cell, all(1.0F)), lines.ahead);
    lines.entering = axis.time_at(near);
    lines.leaving = axis.time_at(hn::Add(lines.cell, lines.ahead));
    return lines;
}

HWY_INLINE PieceAxis piece_along(const Axis& axis, const Lines& lines, Floats begin, Floats end) {
    const Floats one = all(1.0F);
    const Floats origin = hn::Sub(axis.origin, lines.cell);
    const auto part = [&](Floats t) HWY_ATTR {
        const Floats place = hn::MulAdd(t, axis.direction, origin);
        return hn::Min(hn::Max(place, hn::Zero(floats)), one);
    };
    PieceAxis piece;
    piece.enter =
        hn::IfThenElse(hn::Eq(begin, lines.entering), hn::Sub(one, lines.ahead), part(begin));
    piece.leave = hn::IfThenElse(hn::Eq(end, lines.leaving), lines.ahead, part(end));
    piece.way = hn::Sub(piece.leave, piece.enter);
    return piece;
}

HWY_INLINE Piece piece_in(const Rays& rays, const Corners& corners, Ints col, Ints row) {
    const Lines cols = lines_of(rays.col, col);
    const Lines rows = lines_of(rays.row, row);
    Piece piece;
    piece.begin = hn::Max(hn::Max(cols.entering, rows.entering), rays.begin);
    piece.end = hn::Min(hn::Min(cols.leaving, rows.leaving), rays.end);
    piece.col = piece_along(rays.col, cols, piece.begin, piece.end);
    piece.row = piece_along(rays.row, rows, piece.begin, piece.end);
    const Floats twist =
        hn::Sub(hn::Sub(corners.h11, corners.h01), hn::Sub(corners.h10, corners.h00));
    piece.start = hn::Sub(hn::MulAdd(piece.begin, rays.rise, rays.height),
                          height_in(corners, piece.col.enter, piece.row.enter));
    piece.finish = hn::Sub(hn::MulAdd(piece.end, rays.rise, rays.height),
                           height_in(corners, piece.col.leave, piece.row.leave));
    piece.bend = hn::Neg(hn::Mul(twist, hn::Mul(piece.col.way, piece.row.way)));
    piece.slope = hn::Sub(hn::Sub(piece.finish, piece.start), piece.bend);
    return piece;
}

HWY_INLINE Floats under_root(const Piece& piece) {
    return hn::NegMulAdd(hn::Mul(all(4.0F), piece.bend), piece.start,
                         hn::Mul(piece.slope, piece.slope));
}

// Whether the ray crosses the surface from above to below in its cell: its height changes its sign
// on the way, or it dips below the surface, or rises above it, and returns.
HWY_INLINE Lanes crosses(const Piece& piece) {
    const Floats zero = hn::Zero(floats);
    const Lanes begins_below = hn::Lt(piece.start, zero);
    const Lanes ends_below = hn::Lt(piece.finish, zero);
    const Lanes falls = hn::AndNot(begins_below, ends_below);
    // The extremum lies within the piece, on the other side of the surface.
    const Floats twice = hn::Add(piece.bend, piece.bend);
    const Lanes dips =
        hn::And(hn::Lt(piece.slope, zero), hn::Gt(hn::Add(piece.slope, twice), zero));
    const Lanes humps =
        hn::And(hn::Gt(piece.slope, zero), hn::Lt(hn::Add(piece.slope, twice), zero));
    const Lanes returns = hn::Or(hn::AndNot(hn::Or(begins_below, ends_below), dips),
                                 hn::And(hn::And(begins_below, ends_below), humps));
    return hn::Or(falls, hn::And(returns, hn::Gt(under_root(piece), zero)));
}

// The u of the crossing. Precondition: crosses().
HWY_INLINE Floats crossing_of(const Piece& piece) {
    const Floats root = hn::Sqrt(hn::Max(under_root(piece), hn::Zero(floats)));
    const Lanes falls = hn::Lt(piece.slope, hn::Zero(floats));
    const Floats numerator = hn::IfThenElse(falls, hn::Add(piece.start, piece.start),
                                            hn::Sub(hn::Neg(piece.slope), root));
    const Floats denominator =
        hn::IfThenElse(falls, hn::Sub(root, piece.slope), hn::Add(piece.bend, piece.bend));
    const Floats u = hn::Div(numerator, denominator);
    return hn::Min(hn::Max(u, hn::Zero(floats)), all(1.0F));
}

// Where each ray is: a cell, which it enters at t, or inside which it begins.
struct Walk {
    Floats t;
    Ints col;
    Ints row;
    Lanes active;  // not hit, not at the end
    Lanes arrived; // in a cell that it may hit
    Lanes passed;  // misses its cell
    // Only among tiles with walls:
    Floats entry; // t at which it comes in
    Lanes walled; // from another tile
    Lanes below;  // was below the surface where it was last
    Lanes wall;   // hit a wall
    Work work;
};

// The cell before a line.
HWY_INLINE Ints cell_behind(const Axis& axis, Floats line) {
    const Floats near = hn::Sub(line, hn::ConvertTo(floats, axis.ahead));
    return hn::ConvertTo(ints, hn::Add(near, axis.base));
}

// The cell at the start: that of the place, corrected by the t of its lines.
HWY_INLINE Ints cell_at(const Axis& axis, Floats start) {
    const Floats first = hn::Neg(axis.base);
    const Floats last = hn::Add(first, all(static_cast<float>(axis.last)));
    const auto inside = [&](Floats cell) HWY_ATTR { return hn::Min(hn::Max(cell, first), last); };
    const Floats cell = inside(hn::Floor(axis.at(start)));
    const Floats ahead = hn::ConvertTo(floats, axis.ahead);
    const Floats stride = hn::Sub(hn::Add(ahead, ahead), all(1.0F));
    const Floats entering = axis.time_at(hn::Sub(hn::Add(cell, all(1.0F)), ahead));
    const Floats leaving = axis.time_at(hn::Add(cell, ahead));
    const Floats back = hn::IfThenElseZero(hn::Lt(start, entering), stride);
    const Floats onward = hn::IfThenElseZero(hn::Ge(start, leaving), stride);
    const Floats corrected = inside(hn::Add(hn::Sub(cell, back), onward));
    return hn::ConvertTo(ints, hn::Add(corrected, axis.base));
}

HWY_INLINE Walk walk_from(const Rays& rays, Floats start) {
    Walk walk;
    walk.active = hn::Lt(start, rays.end);
    walk.arrived = no_lanes();
    walk.passed = no_lanes();
    walk.wall = no_lanes();
    walk.work = Work::nothing();
    walk.t = hn::IfThenElse(walk.active, start, rays.begin);
    walk.col = cell_at(rays.col, walk.t);
    walk.row = cell_at(rays.row, walk.t);
    return walk;
}

// A line between blocks of cells that a ray crosses next, along one axis.
struct NextLine {
    Floats line; // from the base
    Floats t;
    Floats stride; // to the line behind

    HWY_INLINE void pass(const Axis& axis, Lanes lanes) {
        line = hn::Add(line, hn::IfThenElseZero(lanes, stride));
        t = axis.time_at(line);
    }
};

HWY_INLINE NextLine next_line(const Axis& axis, Ints block, float cells) {
    NextLine next;
    next.line =
        hn::MulSub(hn::ConvertTo(floats, hn::Add(block, axis.ahead)), all(cells), axis.base);
    next.t = axis.time_at(next.line);
    const Floats twice = hn::ConvertTo(floats, hn::Add(axis.ahead, axis.ahead));
    next.stride = hn::MulSub(twice, all(cells), all(cells));
    return next;
}

// The elements of the blocks of a level in TileSamples::maxima.
struct BlockPlaces {
    Ints index;
    Ints col_stride; // to the next block of each ray
    Ints row_stride;

    HWY_INLINE void move(Lanes sideways) {
        index =
            hn::Add(index, hn::IfThenElse(hn::RebindMask(ints, sideways), col_stride, row_stride));
    }
};

HWY_INLINE BlockPlaces places_of(const Rays& rays, const TileSamples& tile, Ints col, Ints row,
                                 int level) {
    const int first_row = 2 * tile.rows - ((2 * tile.rows) >> level);
    const Ints stride = all(tile.stride);
    const auto signs = [](const Axis& axis)
                           HWY_ATTR { return hn::Sub(hn::Add(axis.ahead, axis.ahead), all(1)); };
    return {hn::Add(hn::Mul(hn::Add(row, all(first_row)), stride), col), signs(rays.col),
            hn::Mul(signs(rays.row), stride)};
}

// The heights at these places; anything for rays beyond the tile.
HWY_INLINE Floats maxima_at(const TileSamples& tile, const BlockPlaces& places) {
    const hn::RebindToUnsigned<IntTag> unsigned_ints;
    const int rows = 2 * tile.rows - (tile.rows >> tile.top_level);
    const auto last = hn::Set(unsigned_ints, static_cast<std::uint32_t>(rows * tile.stride - 1));
    const auto index = hn::Min(hn::BitCast(unsigned_ints, places.index), last);
    return hn::GatherIndex(floats, tile.maxima, hn::BitCast(ints, index));
}

// Moves rays from block to block of a level while they are above it, at most `max_steps` times. No
// step waits for the maxima of the one before: rays that have arrived at a block that they may hit
// go on, and their last lines are kept.
template <class Mode>
HWY_INLINE void march(const Rays& rays, const BlockJob& job, int level, int max_steps, Walk& walk) {
    const Lanes lanes = hn::AndNot(walk.arrived, walk.active);
    const auto cells = static_cast<float>(1 << level);
    const Ints first_col = hn::ShiftRightSame(walk.col, level);
    const Ints first_row = hn::ShiftRightSame(walk.row, level);
    NextLine col = next_line(rays.col, first_col, cells);
    NextLine row = next_line(rays.row, first_row, cells);
    BlockPlaces places = places_of(rays, job.tile, first_col, first_row, level);
    Floats kept_col = col.line;
    Floats kept_row = row.line;
    const float lift = job.skips_cells ? job.rays.lift : std::numeric_limits<float>::infinity();
    const Floats height = hn::Add(rays.height, all(job.rays.base_height - lift));
    Floats enter_height = hn::MulAdd(walk.t, rays.rise, height);
    Lanes run = lanes;
    Lanes ended = no_lanes();
    for (int i = 0; i < max_steps && !hn::AllFalse(floats, run); ++i) {
        const Floats next = hn::Min(col.t, row.t);
        const Floats leave_height = hn::MulAdd(hn::Min(next, rays.end), rays.rise, height);
        const Floats highest = maxima_at(job.tile, places);
        if constexpr (Mode::counts) {
            walk.work.step(run, 1);
        }
        Lanes over = hn::And(run, hn::Gt(hn::Min(enter_height, leave_height), highest));
        if constexpr (Mode::has_walls) {
            walk.below = hn::AndNot(over, walk.below);
        }
        over = hn::Or(over, walk.passed);
        walk.passed = no_lanes();
        run = hn::And(over, hn::Lt(next, rays.end));
        ended = hn::Or(ended, hn::AndNot(run, over));
        const Lanes sideways = hn::Le(col.t, row.t);
        col.pass(rays.col, sideways);
        row.pass(rays.row, hn::Not(sideways));
        places.move(sideways);
        enter_height = leave_height;
        kept_col = hn::IfThenElse(run, col.line, kept_col);
        kept_row = hn::IfThenElse(run, row.line, kept_row);
    }
    const Floats entering = hn::Max(rays.col.time_at(hn::Sub(kept_col, col.stride)),
                                    rays.row.time_at(hn::Sub(kept_row, row.stride)));
    walk.t = hn::IfThenElse(lanes, hn::Max(walk.t, entering), walk.t);
    walk.active = hn::AndNot(ended, walk.active);
    const IntLanes moved = hn::RebindMask(ints, lanes);
    if (level == 0) {
        walk.arrived = hn::Or(walk.arrived, hn::AndNot(hn::Or(ended, run), lanes));
        walk.col = hn::IfThenElse(moved, cell_behind(rays.col, kept_col), walk.col);
        walk.row = hn::IfThenElse(moved, cell_behind(rays.row, kept_row), walk.row);
    } else {
        walk.col = hn::IfThenElse(moved, cell_at(rays.col, walk.t), walk.col);
        walk.row = hn::IfThenElse(moved, cell_at(rays.row, walk.t), walk.row);
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

// The pieces of the rays that hit, in memory: registers are short.
struct HitPieces {
    struct Values {
        alignas(64) std::array<float, static_cast<std::size_t>(lane_count)> lanes;

        HWY_INLINE void keep(Floats from, Lanes which) {
            hn::BlendedStore(from, which, floats, lanes.data());
        }
        [[nodiscard]] HWY_INLINE Floats get(Lanes which) const {
            return hn::MaskedLoad(which, floats, lanes.data());
        }
    };
    std::array<Values, 9> piece;
    std::array<Values, 4> corners;

    HWY_INLINE void keep(const Piece& from, const Corners& heights, Lanes which) {
        piece[0].keep(from.begin, which);
        piece[1].keep(from.end, which);
        piece[2].keep(from.col.enter, which);
        piece[3].keep(from.col.way, which);
        piece[4].keep(from.row.enter, which);
        piece[5].keep(from.row.way, which);
        piece[6].keep(from.start, which);
        piece[7].keep(from.slope, which);
        piece[8].keep(from.bend, which);
        corners[0].keep(heights.h00, which);
        corners[1].keep(heights.h10, which);
        corners[2].keep(heights.h01, which);
        corners[3].keep(heights.h11, which);
    }

    // Without `leave` and `finish`.
    [[nodiscard]] HWY_INLINE Piece piece_of(Lanes which) const {
        const auto get = [&](std::size_t index) HWY_ATTR { return piece[index].get(which); };
        Piece kept;
        kept.begin = get(0);
        kept.end = get(1);
        kept.col.enter = get(2);
        kept.col.way = get(3);
        kept.row.enter = get(4);
        kept.row.way = get(5);
        kept.start = get(6);
        kept.slope = get(7);
        kept.bend = get(8);
        return kept;
    }
    [[nodiscard]] HWY_INLINE Corners corners_of(Lanes which) const {
        return {corners[0].get(which), corners[1].get(which), corners[2].get(which),
                corners[3].get(which)};
    }
};

// Ends the rays that hit their cells.
template <class Mode>
HWY_INLINE Lanes solve(const Rays& rays, const BlockJob& job, Walk& walk, HitPieces& pieces) {
    const IntLanes there = hn::RebindMask(ints, walk.arrived);
    const Ints col = hn::IfThenElseZero(there, walk.col);
    const Ints row = hn::IfThenElseZero(there, walk.row);
    const Corners corners = corners_of(job, col, row);
    const Piece piece = piece_in(rays, corners, col, row);
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
    walk.passed = hn::AndNot(hit, walk.arrived);
    walk.arrived = no_lanes();
    return hit;
}

// Whether cells are solved: when three quarters of the lanes have arrived at one, or no other is on
// its way.
HWY_INLINE bool is_time_to_solve(const Walk& walk) {
    const std::size_t arrived = hn::CountTrue(floats, walk.arrived);
    return 4 * arrived >= 3 * lane_count ||
           hn::AllFalse(floats, hn::AndNot(walk.arrived, walk.active));
}

// Walks all rays to their first hit: through ever larger blocks as long as rays find none that they
// may hit. Not inlined: rays of all kinds share it, so that it compiles in a quarter of the time.
template <class Mode>
HWY_NOINLINE Lanes find_hits(const Rays& given, const BlockJob& job, Walk& moved,
                             HitPieces& pieces) {
    const Rays rays = given; // copies, whose vectors registers may hold
    Walk walk = moved;
    constexpr int levels = 2; // between marches
    constexpr int max_steps = 16;
    Lanes hits = no_lanes();
    const int top_level = job.skips_blocks ? job.tile.top_level : 0;
    int top = 0; // a start is near the surface
    if constexpr (Mode::counts) {
        walk.work.begin(walk.active);
    }
    while (!hn::AllFalse(floats, walk.active)) {
        for (int level = top; level > 0; level -= levels) {
            march<Mode>(rays, job, level, max_steps, walk);
        }
        march<Mode>(rays, job, 0, max_steps, walk);
        top = top + levels <= top_level ? top + levels : top;
        if (is_time_to_solve(walk)) {
            hits = hn::Or(hits, solve<Mode>(rays, job, walk, pieces));
            top = 0;
        }
    }
    moved = walk;
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
};

// The hits of the rays that have found nothing yet. `start`: of t.
template <class Mode>
HWY_NOINLINE PacketHits hits_of(Rays rays, const BlockJob& job, Floats start, Met& met) {
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
    PacketHits hits;
    HitPieces pieces{};
    hits.found = find_hits<Mode>(rays, job, walk, pieces);
    const IntLanes found = hn::RebindMask(ints, hits.found);
    hits.col = hn::IfThenElseZero(found, walk.col);
    hits.row = hn::IfThenElseZero(found, walk.row);
    hits.corners = pieces.corners_of(hits.found);
    const Piece piece = pieces.piece_of(hits.found);
    Floats u = crossing_of(piece);
    if constexpr (Mode::has_walls) {
        u = hn::IfThenZeroElse(walk.wall, u);
        met.below = walk.below;
    }
    hits.t = hn::MulAdd(u, hn::Sub(piece.end, piece.begin), piece.begin);
    hits.col_part = hn::MulAdd(u, piece.col.way, piece.col.enter);
    hits.row_part = hn::MulAdd(u, piece.row.way, piece.row.enter);
    hits.height = height_in(hits.corners, hits.col_part, hits.row_part);
    if constexpr (Mode::has_walls) {
        const Floats on_ray = hn::MulAdd(hits.t, rays.rise, rays.height);
        hits.height = hn::IfThenElse(walk.wall, on_ray, hits.height);
    }
    if constexpr (Mode::counts) {
        met.work = walk.work;
    }
    met.found = hn::Or(met.found, hits.found);
    return hits;
}

} // namespace reljef::cast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
