// Which hits of a packet the sun reaches. Included once for each instruction set.
#if defined(RELJEF_PACKET_SUN_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELJEF_PACKET_SUN_INL_H
#undef RELJEF_PACKET_SUN_INL_H
#else
#define RELJEF_PACKET_SUN_INL_H
#endif

#include <limits>

#include "engine/cast/packet_walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace reljef::cast::HWY_NAMESPACE {

// A tile that may hide the sun, for the functions that walk through it.
HWY_INLINE void target_sun_tile(const BlockJob& job, const SunTile& tile, BlockJob& target) {
    target.tile = tile.tile;
    target.rays.base_height = job.rays.base_height;
    target.rays.lift = job.rays.lift + tile.lift;
    target.rays.highest = tile.highest - job.rays.base_height + target.rays.lift;
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

// The order of tiles does not matter: a ray that is below one somewhere does not reach the sun.
HWY_INLINE Lanes hidden_from_sun(const BlockJob& job, const PacketHits& hits) {
    Lanes hidden = no_lanes();
    BlockJob target;
    for (const SunTile& tile : job.sun_tiles) {
        const Lanes open = hn::AndNot(hidden, hits.found);
        if (hn::AllFalse(floats, open)) {
            break;
        }
        target_sun_tile(job, tile, target);
        const Rays rays = sun_rays(job, tile, target, hits);
        const Entry entry = entry_of(rays);
        Walk walk = walk_from(rays, hn::Max(entry.t(), rays.begin));
        walk.active = hn::And(walk.active, open);
        walk.entry = hn::Max(entry.t(), rays.begin);
        walk.walled = hn::Gt(entry.t(), rays.begin);
        walk.below = no_lanes();
        HitPieces pieces{};
        hidden = hn::Or(hidden, find_hits<true>(rays, target, walk, pieces));
    }
    return hidden;
}

} // namespace reljef::cast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
