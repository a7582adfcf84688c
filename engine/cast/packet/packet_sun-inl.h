// Which hits of a packet the sun reaches. Included once for each instruction set.
#if defined(RELJEF_PACKET_SUN_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELJEF_PACKET_SUN_INL_H
#undef RELJEF_PACKET_SUN_INL_H
#else
#define RELJEF_PACKET_SUN_INL_H
#endif

#include <array>
#include <cstddef>
#include <limits>
#include <type_traits>

#include "engine/cast/packet/packet_bends-inl.h"
#include "engine/cast/packet/packet_walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace reljef::cast::HWY_NAMESPACE {

// How the surface lies: its slopes at the hits, metres per sample.
struct Slopes {
    Floats col;
    Floats row;
};

HWY_INLINE Slopes slopes_of(const PacketHits& hits) {
    const Corners& corners = hits.corners;
    return {
        mixed(hn::Sub(corners.h10, corners.h00), hn::Sub(corners.h11, corners.h01), hits.row_part),
        mixed(hn::Sub(corners.h01, corners.h00), hn::Sub(corners.h11, corners.h10), hits.col_part)};
}

// The hits whose surface rises less than the rays to the sun. From the others these lead into the
// ground, whatever rounding makes of their starts.
HWY_INLINE Lanes facing_sun(const BlockJob& job, const PacketHits& hits) {
    const glm::vec3 to_sun = job.sun_tiles.front().to_sun;
    const Slopes slopes = slopes_of(hits);
    const Floats ground = hn::MulAdd(slopes.col, all(to_sun.x), hn::Mul(slopes.row, all(to_sun.y)));
    return hn::And(hits.found, hn::Lt(ground, all(to_sun.z)));
}

// A tile that may hide the sun, for the functions that walk through it.
HWY_INLINE void target_sun_tile(const BlockJob& job, const SunTile& tile, BlockJob& target) {
    target.tile = tile.tile;
    target.rays.base_height = job.rays.base_height;
    target.rays.lift = job.rays.lift + tile.lift;
    target.rays.highest = tile.highest - job.rays.base_height + target.rays.lift;
    target.skips_blocks = job.skips_blocks;
    target.skips_cells = job.skips_cells;
    target.rays.end = 0.5F * std::numeric_limits<float>::max();
}

// From the hits, above which they begin by what floats round.
HWY_INLINE Rays sun_rays(const BlockJob& job, const SunTile& tile, const BlockJob& target,
                         const PacketHits& hits) {
    const auto axis = [&](int index, Ints cell, Floats part) HWY_ATTR {
        const int from = tile.is_of_hits ? job.rays.base[index] : 0;
        const Floats place = hn::Add(hn::ConvertTo(floats, hn::Sub(cell, all(from))), part);
        const Floats origin = hn::MulAdd(place, all(tile.scale[index]), all(tile.offset[index]));
        return axis_of(origin, all(tile.to_sun[index]), tile.base[index] + from,
                       tile.tile.cells[index]);
    };
    Rays rays;
    rays.col = axis(0, hits.col, hits.col_part);
    rays.row = axis(1, hits.row, hits.row_part);
    rays.height = hn::Add(hits.height, all(target.rays.lift));
    rays.rise = all(tile.to_sun.z);
    rays.begin = hn::Zero(floats);
    rays.end = end_of(rays, target.rays);
    return rays;
}

struct SunLanes {
    Lanes open;      // not hidden yet
    Lanes continued; // a chord ends where this ray begins, above all ground
};

// The rays that a tile hides from the sun.
template <class SunMode>
HWY_NOINLINE Lanes hidden_by(const Rays& rays, const BlockJob& target, const SunLanes& lanes,
                             Work& work) {
    const Entry entry = entry_of(rays);
    std::array<Walk, 1> walks{walk_from(rays, hn::Max(entry.t(), rays.begin))};
    Walk& walk = walks.front();
    walk.active = hn::And(walk.active, lanes.open);
    walk.entry = hn::Max(entry.t(), rays.begin);
    walk.walled = hn::Or(lanes.continued, hn::Gt(entry.t(), rays.begin));
    walk.below = no_lanes();
    walk.work = work;
    std::array<HitPieces, 1> pieces;
    const std::array<Lanes, 1> hits = find_hits<SunMode, 1>({rays}, target, walks, pieces);
    if constexpr (SunMode::counts) {
        work = walk.work;
    }
    return hits.front();
}

// The order of tiles does not matter: a ray that is below one somewhere does not reach the sun.
template <class Mode>
HWY_NOINLINE Lanes hidden_from_sun(const BlockJob& job, const PacketHits& hits, Work& work) {
    using SunMode = std::conditional_t<Mode::counts, Counted, AmongTiles>;
    Lanes hidden = no_lanes();
    BlockJob target;
    for (const SunTile& tile : job.sun_tiles) {
        const Lanes open = hn::AndNot(hidden, hits.found);
        if (hn::AllFalse(floats, open)) {
            break;
        }
        target_sun_tile(job, tile, target);
        hidden = hn::Or(hidden, hidden_by<SunMode>(sun_rays(job, tile, target, hits), target,
                                                   {open, no_lanes()}, work));
    }
    return hidden;
}

// The hits whose surface rises less than the first chords; see facing_sun().
HWY_INLINE Lanes facing_chords(const BlockJob& job, const PacketHits& hits, const BentRays& rays) {
    const SunWay way = way_to(*job.bends, rays, job.bends->parts[1]);
    const glm::vec2 scale = job.sun_tiles.front().bend_scale;
    const Slopes slopes = slopes_of(hits);
    const Floats ground = hn::MulAdd(hn::Mul(slopes.col, all(scale.x)), way[0],
                                     hn::Mul(hn::Mul(slopes.row, all(scale.y)), way[1]));
    return hn::And(hits.found, hn::Lt(ground, way[2]));
}

// From one end of a chord to the other, along one axis of a tile. Each lane has its own base, near
// the place where its chord begins: so it is as precise far from the eye.
HWY_INLINE Axis chord_axis(const SunTile& tile, const PacketHits& hits, int index,
                           const std::array<SunWay, 2>& ends) {
    const Floats samples = all(tile.bend_scale[index]);
    const auto axis = static_cast<std::size_t>(index);
    const Floats part = index == 0 ? hits.col_part : hits.row_part;
    Floats whole = hn::ConvertTo(floats, index == 0 ? hits.col : hits.row);
    Floats rest = part;
    if (!tile.is_of_hits) {
        const Floats scaled = hn::Mul(whole, all(tile.scale[index]));
        const Floats base = hn::Floor(scaled);
        rest = hn::Add(hn::MulSub(whole, all(tile.scale[index]), base),
                       hn::MulAdd(part, all(tile.scale[index]), all(tile.offset[index])));
        whole = hn::Add(base, all(static_cast<float>(tile.base[index])));
    }
    const Floats begin = hn::MulAdd(ends[0][axis], samples, rest);
    const Floats cells = hn::Floor(begin);
    Axis made =
        axis_of(hn::Sub(begin, cells), hn::Mul(hn::Sub(ends[1][axis], ends[0][axis]), samples), 0,
                tile.tile.cells[index]);
    made.base = hn::Add(whole, cells);
    return made;
}

// `ends`: ways from the hits.
HWY_INLINE Rays chord_rays(const SunTile& tile, const BlockJob& target, const PacketHits& hits,
                           const std::array<SunWay, 2>& ends) {
    Rays rays;
    rays.col = chord_axis(tile, hits, 0, ends);
    rays.row = chord_axis(tile, hits, 1, ends);
    rays.height = hn::Add(hn::Add(hits.height, all(target.rays.lift)), ends[0][2]);
    rays.rise = hn::Sub(ends[1][2], ends[0][2]);
    rays.begin = hn::Zero(floats);
    rays.end = end_of(rays, target.rays);
    return rays;
}

// Each chord begins where the last one has ended, above the surface: a ray that is below it
// somewhere does not reach the sun. So the order of tiles does not matter.
template <class Mode>
HWY_NOINLINE Lanes hidden_along_chords(const BlockJob& job, const PacketHits& hits,
                                       const BentRays& sun, Work& work) {
    using SunMode = std::conditional_t<Mode::counts, Counted, AmongTiles>;
    const SunBends& bends = *job.bends;
    const auto way_to_end = [&](int end) HWY_ATTR {
        return way_to(bends, sun, bends.parts[static_cast<std::size_t>(end)]);
    };
    Lanes hidden = no_lanes();
    BlockJob target;
    for (const SunTile& tile : job.sun_tiles) {
        target_sun_tile(job, tile, target);
        target.rays.lowest = std::numeric_limits<float>::lowest(); // chords may fall
        target.rays.end = 1.0F;
        Lanes open = hn::AndNot(hidden, hits.found);
        std::array<SunWay, 2> ends;
        ends[1] = way_to_end(tile.first_chord);
        for (int chord = tile.first_chord; chord <= tile.last_chord && !hn::AllFalse(floats, open);
             ++chord) {
            ends[0] = ends[1];
            ends[1] = way_to_end(chord + 1);
            const Rays rays = chord_rays(tile, target, hits, ends);
            const SunLanes lanes{open, chord > 0 ? hits.found : no_lanes()};
            const Lanes met = hidden_by<SunMode>(rays, target, lanes, work);
            hidden = hn::Or(hidden, met);
            // Those that are above the tile and rise do not return.
            const Lanes above =
                hn::And(hn::Gt(hn::Add(rays.height, rays.rise), all(target.rays.highest)),
                        hn::Ge(rays.rise, hn::Zero(floats)));
            open = hn::AndNot(hn::Or(met, above), open);
        }
    }
    return hidden;
}

// Of hits whose rays bend.
template <class Mode>
HWY_NOINLINE Lanes seen_along_chords(const BlockJob& job, const PacketHits& hits, Work& work) {
    const BentRays rays = bent_rays(job, hits);
    PacketHits open = hits;
    open.found = facing_chords(job, hits, rays);
    return hn::AndNot(hidden_along_chords<Mode>(job, open, rays, work), open.found);
}

// What is certain of the sun in the hits' cells.
HWY_INLINE Ints certain_sun_of(const BlockJob& job, const PacketHits& hits) {
    constexpr int cells_a_word_bits = 4;
    const Ints word = hn::Add(hn::Mul(hits.row, all(job.certain_stride)),
                              hn::ShiftRight<cells_a_word_bits>(hits.col));
    const Ints bits = hn::GatherIndex(ints, job.certain_sun, word);
    const Ints cell = hn::And(hits.col, all((1 << cells_a_word_bits) - 1));
    return hn::And(hn::Shr(bits, hn::Add(cell, cell)), all(std::int32_t{3}));
}

// The hits that the sun reaches. Rays look for it only where it is not certain.
template <class Mode>
HWY_INLINE Lanes seen_by_sun(const BlockJob& job, const PacketHits& hits, Work& work) {
    if (job.bends != nullptr) {
        return seen_along_chords<Mode>(job, hits, work);
    }
    Lanes lit = no_lanes();
    PacketHits open = hits;
    open.found = facing_sun(job, hits);
    if (job.certain_sun != nullptr) {
        if constexpr (Mode::counts) {
            work.tap(hits.found, 1);
        }
        const Ints certain = certain_sun_of(job, hits);
        const auto is = [&](std::int32_t what)
                            HWY_ATTR { return hn::RebindMask(floats, hn::Eq(certain, all(what))); };
        lit = hn::And(hits.found, is(sun_certain));
        open.found = hn::And(open.found, is(0));
    }
    if (hn::AllFalse(floats, open.found)) {
        return lit;
    }
    return hn::Or(lit, hn::AndNot(hidden_from_sun<Mode>(job, open, work), open.found));
}

} // namespace reljef::cast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
