// Where the rays of a packet meet the bilinear surface of their cells. Included once for each
// instruction set.
#if defined(RELJEF_PACKET_CELLS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELJEF_PACKET_CELLS_INL_H
#undef RELJEF_PACKET_CELLS_INL_H
#else
#define RELJEF_PACKET_CELLS_INL_H
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

// A cell, and the t at which the ray crosses its lines.
struct Lines {
    Floats cell; // from the base
    Floats ahead;
    Floats entering;
    Floats leaving;
};

HWY_INLINE Lines lines_of(const Axis& axis, Floats next_line) {
    return {axis.cell_before(next_line), axis.ahead, axis.time_at(hn::Sub(next_line, axis.stride)),
            axis.time_at(next_line)};
}

struct CellLines {
    Lines col;
    Lines row;
};

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

HWY_INLINE Piece piece_in(const Rays& rays, const Corners& corners, const CellLines& lines) {
    const auto& [cols, rows] = lines;
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

// The pieces of the rays that hit, in memory: registers are few.
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

} // namespace reljef::cast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
