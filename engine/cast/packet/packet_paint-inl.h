// The colours of a packet of rays, as the shaders of engine/render compute them. Included once for
// each instruction set.
#if defined(RELJEF_PACKET_PAINT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELJEF_PACKET_PAINT_INL_H
#undef RELJEF_PACKET_PAINT_INL_H
#else
#define RELJEF_PACKET_PAINT_INL_H
#endif

#include <bit>
#include <cstdint>
#include <limits>

#include "engine/cast/packet/packet_air-inl.h"
#include "engine/cast/packet/packet_contours-inl.h"
#include "engine/cast/packet/packet_detail-inl.h"
#include "engine/cast/packet/packet_facades-inl.h"
#include "engine/cast/packet/packet_grain-inl.h"
#include "engine/cast/packet/packet_light-inl.h"
#include "engine/cast/packet/packet_points-inl.h"
#include "engine/cast/packet/packet_walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace reljef::cast::HWY_NAMESPACE {

// The nearest 8-bit sRGB value within 0.09 (IEC 61966-2-1), for linear light, in the low byte. The
// other bits are those of 2^23, whose last place is 1.
HWY_INLINE Ints srgb_bits(Floats linear) {
    const Floats inside = hn::Min(hn::Max(linear, hn::Zero(floats)), all(1.0F));
    const Floats root = hn::Sqrt(inside); // a smoother function of it
    const Floats high = cubic(root, 3.0326164F, -3.5527477F, 2.2484992F, -0.58427072F);
    const Floats curve =
        hn::MulAdd(hn::MulAdd(hn::MulAdd(high, root, all(-1.6456115F)), root, all(1.5423363F)),
                   root, all(-0.040864021F));
    const Floats encoded =
        hn::IfThenElse(hn::Le(inside, all(0.0031308F)), hn::Mul(inside, all(12.92F)), curve);
    return hn::BitCast(ints, hn::Add(hn::Mul(encoded, all(255.0F)), all(0x1p23F)));
}

HWY_INLINE Ints bytes_of(const Color& color) {
    const Ints green = hn::ShiftLeft<8>(srgb_bits(color.g));
    const Ints blue = hn::ShiftLeft<16>(srgb_bits(color.b));
    // Opaque: 255 covers the exponent that the bits of red have there.
    static_assert((std::bit_cast<std::uint32_t>(0x1p23F) & 0x00FFFFFFU) == 0);
    return hn::Or(hn::Or(srgb_bits(color.r), green), hn::Or(blue, hn::ShiftLeft<24>(all(255))));
}

// How hits lie to their rays.
struct Facing {
    Slopes slopes;
    Floats per_facing; // t per metre of height above the plane that touches the surface
};

HWY_INLINE Facing facing_of(const Rays& rays, const PacketHits& hits) {
    const Slopes slopes = slopes_of(hits);
    const Floats facing = hn::Sub(rays.rise, hn::MulAdd(slopes.col, rays.col.direction,
                                                        hn::Mul(slopes.row, rays.row.direction)));
    return {slopes, hn::Div(all(1.0F), moving(facing))};
}

// How far the hit moves from a pixel to its neighbour in the plane that touches the surface,
// samples.
struct Moved {
    Floats col;
    Floats row;
};

// `origin`, `direction`: the changes of the ray.
HWY_INLINE Moved moved_in_plane(const Rays& rays, const PacketHits& hits, const Facing& facing,
                                glm::vec3 origin, glm::vec3 direction) {
    const auto moved = [&](int axis) HWY_ATTR {
        return hn::MulAdd(hits.t, all(direction[axis]), all(origin[axis]));
    };
    const Slopes& slopes = facing.slopes;
    const Floats col = moved(0);
    const Floats row = moved(1);
    const Floats above = hn::Sub(moved(2), hn::MulAdd(slopes.col, col, hn::Mul(slopes.row, row)));
    const Floats later = hn::Neg(hn::Mul(above, facing.per_facing)); // t
    return {hn::MulAdd(later, rays.col.direction, col), hn::MulAdd(later, rays.row.direction, row)};
}

HWY_INLINE Floats squared_texels(const TilePaint& paint, const Moved& moved) {
    const Floats u = hn::Mul(moved.col, all(paint.texels_per_sample.x));
    const Floats v = hn::Mul(moved.row, all(paint.texels_per_sample.y));
    return hn::MulAdd(u, u, hn::Mul(v, v));
}

// By which the height changes from a pixel to its neighbours, metres.
HWY_INLINE Floats change_of_height(const BlockJob& job, const Rays& rays, const PacketHits& hits) {
    const Facing facing = facing_of(rays, hits);
    const BlockRays& block = job.rays;
    const auto change = [&](const Moved& moved) HWY_ATTR {
        return hn::MulAdd(facing.slopes.col, moved.col, hn::Mul(facing.slopes.row, moved.row));
    };
    const Floats right =
        change(moved_in_plane(rays, hits, facing, block.origin.right, block.direction.right));
    const Floats down =
        change(moved_in_plane(rays, hits, facing, block.origin.down, block.direction.down));
    return hn::Sqrt(hn::MulAdd(right, right, hn::Mul(down, down)));
}

// The mip level of a packet's hits, limited to an anisotropy of 8 by `longest_texels`.
HWY_INLINE Floats level_of(const BlockJob& job, const Rays& rays, const PacketHits& hits,
                           Floats metres) {
    const TilePaint& paint = *job.paint;
    const Facing facing = facing_of(rays, hits);
    const BlockRays& block = job.rays;
    const Floats right = squared_texels(
        paint, moved_in_plane(rays, hits, facing, block.origin.right, block.direction.right));
    const Floats down = squared_texels(
        paint, moved_in_plane(rays, hits, facing, block.origin.down, block.direction.down));
    const Floats longest =
        hn::MulAdd(metres, all(paint.longest_texels.y), all(paint.longest_texels.x));
    const Floats square = hn::Min(hn::Max(right, down), hn::Mul(longest, longest));
    const Floats level = hn::Mul(all(0.5F), log2_of(hn::Max(square, all(1.0F))));
    return hn::Min(level, all(static_cast<float>(paint.level_count - 1)));
}

HWY_INLINE GroundPlace place_of(const BlockPaint& paint, const PixelOffsets& pixels,
                                const ViewRays& view, Floats t, Floats metres) {
    GroundPlace place{{}, {view.x, view.y, view.z}, metres, view.length};
    const Floats depth = hn::Add(t, all(paint.anchor));
    for (std::size_t axis = 0; axis < place.from_eye.size(); ++axis) {
        const Floats origin = pixels.of(paint.origin, static_cast<int>(axis));
        place.from_eye[axis] = hn::MulAdd(place.view[axis], depth, origin);
    }
    return place;
}

// The lanes from whose hits no mesh hides the sun.
HWY_INLINE Lanes beside_meshes(const BlockPaint& paint, const PixelOffsets& pixels,
                               const ViewRays& view, Floats t, Lanes sunny) {
    constexpr auto count = static_cast<std::size_t>(lane_count);
    alignas(64) std::array<std::array<float, count>, 3> places;
    const GroundPlace place = place_of(paint, pixels, view, t, hn::Zero(floats));
    for (std::size_t axis = 0; axis < places.size(); ++axis) {
        hn::Store(place.from_eye[axis], floats, places[axis].data());
    }
    std::array<std::uint8_t, 8> bytes{};
    hn::StoreMaskBits(floats, sunny, bytes.data());
    const unsigned lanes = bytes[0] | static_cast<unsigned>(bytes[1]) << 8U;
    const std::uint32_t hidden = paint.mesh_shadow.hidden(
        paint.mesh_shadow.meshes, {places[0].data(), places[1].data(), places[2].data()}, lanes);
    const std::uint32_t left = lanes & ~hidden;
    bytes = {static_cast<std::uint8_t>(left & 255U), static_cast<std::uint8_t>(left >> 8U)};
    return hn::LoadMaskBits(floats, bytes.data());
}

// Whether ground may look other than its maps.
HWY_INLINE bool is_covered(const BlockPaint& paint) {
    return paint.grain != nullptr || paint.facades != nullptr || paint.contours.interval > 0.0F ||
           paint.detail != nullptr;
}

// Grain, façades and contours over the ground.
template <class WithoutShadow>
HWY_INLINE Color with_overlays(const BlockJob& job, const BlockPaint& paint, const Rays& rays,
                               const GroundPlace& place, const PacketHits& hits,
                               const GroundLooks& looks, const WithoutShadow& without_shadow) {
    Color lit = looks.lit;
    if (paint.grain != nullptr) {
        lit = with_grain(paint, *job.paint, place, hits, looks.by_sun, lit);
    }
    const Floats height = hn::Add(hits.height, all(job.rays.base_height));
    if (paint.facades != nullptr) {
        lit = with_facades(job, paint, place, hits, height, lit, without_shadow);
    }
    if (paint.contours.interval > 0.0F) {
        lit = with_contours(paint.contours, height, change_of_height(job, rays, hits), lit);
    }
    return lit;
}

// Of the hits, seen through the air (Koschmieder 1924).
template <class Mode>
HWY_INLINE Color ground_color(const BlockJob& job, const BlockPaint& paint,
                              const PixelOffsets& pixels, const Rays& rays, const ViewRays& view,
                              const PacketHits& hits, Work& work) {
    const Floats metres = hn::Mul(hn::Add(hits.t, all(paint.anchor)), view.length);
    const auto without_shadow = [&](Lanes sunny) HWY_ATTR {
        const bool is_open =
            Mode::counts || paint.mesh_shadow.hidden == nullptr || hn::AllFalse(floats, sunny);
        return is_open ? sunny : beside_meshes(paint, pixels, view, hits.t, sunny);
    };
    const Floats level = level_of(job, rays, hits, metres);
    Lanes sun_seen = no_lanes();
    const auto note_sunny = [&](Lanes sunny) HWY_ATTR { return sun_seen = without_shadow(sunny); };
    Color lit = lit_color<Mode>(job, hits, level, note_sunny, work);
    const Color by_sun = lit;
    if (!Mode::counts && job.albedo != nullptr && !paint.point_lights.empty()) {
        const GroundPlace place = place_of(paint, pixels, view, hits.t, metres);
        lit = added(lit, reflected_from_points(job, paint, place.from_eye, hits, level));
    }
    if (!Mode::counts && is_covered(paint)) {
        const GroundPlace place = place_of(paint, pixels, view, hits.t, metres);
        const GroundLooks looks{level, sun_seen, by_sun, lit};
        const bool has_detail = paint.detail != nullptr && job.albedo != nullptr;
        const Floats share = has_detail ? seen_share(*paint.detail, metres, hits.found) : all(0.0F);
        if (!hn::AllTrue(floats, hn::Or(hn::Not(hits.found), hn::Eq(share, all(1.0F))))) {
            lit = with_overlays(job, paint, rays, place, hits, looks, without_shadow);
        }
        if (!hn::AllTrue(floats, hn::Eq(share, hn::Zero(floats)))) {
            const Color detailed = detailed_color(job, paint, place, hits, looks);
            lit = chosen(hn::Eq(share, all(1.0F)), detailed, mixed(lit, detailed, share));
        }
    }
    return paint.has_air ? through_air(paint, angles_of(paint, view), lit, metres) : lit;
}

// What a packet shows.
struct Look {
    Color color;
    Floats t; // infinity: sky
    Work work;
};

// Beyond the sides of a triangle, pixels: less than a step of the places of samples, so that
// neighbours join.
constexpr float joined = 1.0F / 64.0F;

// Whether a triangle may cover pixels between two places.
HWY_INLINE bool may_cover(const WallTriangle& wall, glm::vec2 low, glm::vec2 high) {
    return wall.low.x <= high.x + joined && wall.high.x >= low.x - joined &&
           wall.low.y <= high.y + joined && wall.high.y >= low.y - joined;
}

HWY_INLINE Floats linear_at(glm::vec3 plane, const PixelOffsets& pixels) {
    return hn::MulAdd(pixels.right, all(plane.x),
                      hn::MulAdd(pixels.down, all(plane.y), all(plane.z)));
}

// Pixels inside of a triangle. Its bounds cut the tips that the joints have beyond narrow corners.
HWY_INLINE Floats inside_of(const WallTriangle& wall, const PixelOffsets& pixels) {
    const Floats sides =
        hn::Min(hn::Min(linear_at(wall.sides[0], pixels), linear_at(wall.sides[1], pixels)),
                linear_at(wall.sides[2], pixels));
    const auto between = [](Floats place, float low, float high) HWY_ATTR {
        return hn::Min(hn::Sub(place, all(low)), hn::Sub(all(high), place));
    };
    return hn::Min(sides, hn::Min(between(pixels.right, wall.low.x, wall.high.x),
                                  between(pixels.down, wall.low.y, wall.high.y)));
}

// Walls, or all that a packet shows.
struct TrueLook {
    Lanes found; // walls, and no mesh before them
    Look look;
    Floats t; // without the shifts of `look`
};

// The walls below the terrain: in front of all ground.
HWY_INLINE TrueLook wall_look_of(const BlockPaint& paint, const PixelOffsets& pixels) {
    const Floats never = all(std::numeric_limits<float>::infinity());
    TrueLook walls{no_lanes(), {all(glm::vec3(0.0F)), never, Work::nothing()}, never};
    const glm::vec2 low(hn::GetLane(hn::MinOfLanes(floats, pixels.right)),
                        hn::GetLane(hn::MinOfLanes(floats, pixels.down)));
    const glm::vec2 high(hn::GetLane(hn::MaxOfLanes(floats, pixels.right)),
                         hn::GetLane(hn::MaxOfLanes(floats, pixels.down)));
    for (const WallTriangle& wall : paint.walls) {
        if (!may_cover(wall, low, high)) {
            continue;
        }
        const Lanes found = hn::Ge(inside_of(wall, pixels), all(-joined));
        const Floats linear = linear_at(wall.depth, pixels);
        const Floats depth = paint.is_perspective ? hn::Div(all(1.0F), moving(linear)) : linear;
        walls.look.color = chosen(found, all(wall.color), walls.look.color);
        walls.look.t = hn::IfThenElse(found, hn::Sub(depth, all(paint.anchor)), walls.look.t);
        walls.found = hn::Or(walls.found, found);
    }
    walls.t = walls.look.t;
    if (!hn::AllFalse(floats, walls.found)) {
        const Floats depth = hn::Add(walls.look.t, all(paint.anchor));
        const ViewRays view = view_rays(paint, pixels);
        const Floats metres = hn::IfThenElseZero(walls.found, hn::Mul(depth, view.length));
        if (paint.has_air) {
            walls.look.color = through_air(paint, angles_of(paint, view), walls.look.color, metres);
        }
        // As if nearer: so their border to the ground, at the same depth, gets several samples.
        constexpr float nearer = 0.75F;
        walls.look.t = hn::IfThenElse(
            walls.found, hn::Sub(hn::Mul(depth, all(nearer)), all(paint.anchor)), never);
    }
    return walls;
}

// `start_of(k)`: where the rays of packet k may begin.
template <class StartOf> HWY_INLINE Pair<Floats> starts_by(const StartOf& start_of) {
    return {start_of(std::size_t{0}), start_of(std::size_t{1})};
}

HWY_INLINE bool is_any_ray(const Pair<Floats>& starts) {
    const Floats never = all(std::numeric_limits<float>::infinity());
    return !hn::AllFalse(floats, hn::Or(hn::Lt(starts[0], never), hn::Lt(starts[1], never)));
}

// A packet while it looks for the ground of one tile after the other.
struct GroundPacket {
    ViewRays view;
    Look look;

    // What it shows of a tile.
    template <class Mode>
    HWY_INLINE void add(const BlockJob& job, const BlockPaint& paint, const PixelOffsets& pixels,
                        const Rays& rays, const PacketHits& hits, Met& met) {
        if (hn::AllFalse(floats, hits.found)) {
            return;
        }
        const Color color = ground_color<Mode>(job, paint, pixels, rays, view, hits, met.work);
        look.color = chosen(hits.found, color, look.color);
        look.t = hn::IfThenElse(hits.found, hits.t, look.t);
    }

    // The sky where it shows no tile.
    template <class Mode>
    HWY_INLINE Look end(const BlockPaint& paint, const PixelOffsets& pixels, const Met& met) const {
        Look shown = look;
        if (!hn::AllTrue(floats, met.found)) {
            shown.color = chosen(met.found, look.color, sky_color(paint, pixels, view));
        }
        if constexpr (Mode::counts) {
            shown.work = met.work;
        }
        return shown;
    }
};

// `start_of(job, k)`: where the rays of packet k may begin.
template <class Mode, class StartOf>
HWY_NOINLINE Pair<Look> ground_looks_of(const BlockJobs& jobs, const BlockPaint& paint,
                                        const Pair<PixelOffsets>& pixels, const StartOf& start_of) {
    const Floats never = all(std::numeric_limits<float>::infinity());
    Pair<GroundPacket> packets;
    Pair<Met> met;
#pragma GCC unroll 2
    for (std::size_t k = 0; k < packets_a_pair; ++k) {
        packets[k].view = view_rays(paint, pixels[k]);
        packets[k].look = {all(glm::vec3(0.0F)), never, Work::nothing()};
        met[k] = Met::nothing();
        met[k].has_walls = jobs.has_walls;
    }
    for (BlockJob& job : jobs.tiles) {
        const Pair<Floats> starts =
            starts_by([&](std::size_t k) HWY_ATTR { return start_of(job, k); });
        if (!is_any_ray(starts)) {
            continue;
        }
        Pair<Rays> rays = rays_of(job, pixels);
        const Pair<PacketHits> hits = hits_of<Mode>(rays, job, starts, met);
        packets[0].template add<Mode>(job, paint, pixels[0], rays[0], hits[0], met[0]);
        packets[1].template add<Mode>(job, paint, pixels[1], rays[1], hits[1], met[1]);
        if (hn::AllTrue(floats, hn::And(met[0].found, met[1].found))) {
            break;
        }
    }
    return {packets[0].template end<Mode>(paint, pixels[0], met[0]),
            packets[1].template end<Mode>(paint, pixels[1], met[1])};
}

HWY_INLINE TrueLook behind_walls(const TrueLook& walls, const Look& ground) {
    return {walls.found,
            {chosen(walls.found, walls.look.color, ground.color),
             hn::IfThenElse(walls.found, walls.look.t, ground.t), ground.work},
            hn::IfThenElse(walls.found, walls.t, ground.t)};
}

// Meshes in front of or behind all else. `mesh_values(values)`: those of the packet's pixels.
template <class MeshValues>
HWY_INLINE TrueLook with_meshes(const TrueLook& behind, const BlockPaint& paint,
                                const PixelOffsets& pixels, const MeshValues& mesh_values) {
    const BlockMeshes& meshes = *paint.meshes;
    const Floats t = mesh_values(meshes.t);
    const Floats never = all(std::numeric_limits<float>::infinity());
    const Lanes found = hn::And(hn::Le(t, behind.t), hn::Lt(t, never));
    if (hn::AllFalse(floats, found)) {
        return behind;
    }
    Color color{mesh_values(meshes.color[0]), mesh_values(meshes.color[1]),
                mesh_values(meshes.color[2])};
    const Floats depth = hn::IfThenElseZero(found, hn::Add(t, all(paint.anchor)));
    if (paint.has_air) {
        const ViewRays view = view_rays(paint, pixels);
        color = through_air(paint, angles_of(paint, view), color, hn::Mul(depth, view.length));
    }
    const Floats nearer = hn::Sub(hn::Mul(depth, mesh_values(meshes.nearness)), all(paint.anchor));
    return {hn::AndNot(found, behind.found),
            {chosen(found, color, behind.look.color), hn::IfThenElse(found, nearer, behind.look.t),
             behind.look.work},
            hn::IfThenElse(found, t, behind.t)};
}

// Walls, with the ground behind them.
template <class Mode, class StartOf>
HWY_INLINE Pair<TrueLook> walls_and_ground(const BlockJobs& jobs, const BlockPaint& paint,
                                           const Pair<PixelOffsets>& pixels,
                                           const StartOf& start_of) {
    Pair<TrueLook> looks{wall_look_of(paint, pixels[0]), wall_look_of(paint, pixels[1])};
    if (hn::AllTrue(floats, hn::And(looks[0].found, looks[1].found))) {
        return looks;
    }
    const auto start_beside = [&](BlockJob& job, std::size_t k) HWY_ATTR {
        const Floats never = all(std::numeric_limits<float>::infinity());
        return hn::IfThenElse(looks[k].found, never, start_of(job, k));
    };
    const Pair<Look> ground = ground_looks_of<Mode>(jobs, paint, pixels, start_beside);
    return {behind_walls(looks[0], ground[0]), behind_walls(looks[1], ground[1])};
}

// `mesh_values(values, k)`: those of the pixels of packet k.
template <class Mode, class StartOf, class MeshValues>
HWY_INLINE Pair<TrueLook> looks_of(const BlockJobs& jobs, const BlockPaint& paint,
                                   const Pair<PixelOffsets>& pixels, const StartOf& start_of,
                                   const MeshValues& mesh_values) {
    if (paint.walls.empty() && paint.meshes == nullptr) {
        const Pair<Look> ground = ground_looks_of<Mode>(jobs, paint, pixels, start_of);
        return {TrueLook{no_lanes(), ground[0], ground[0].t},
                TrueLook{no_lanes(), ground[1], ground[1].t}};
    }
    Pair<TrueLook> looks = walls_and_ground<Mode>(jobs, paint, pixels, start_of);
    if (paint.meshes == nullptr) {
        return looks;
    }
    for (std::size_t k = 0; k < packets_a_pair; ++k) {
        const auto values = [&](const float* of) HWY_ATTR { return mesh_values(of, k); };
        looks[k] = with_meshes(looks[k], paint, pixels[k], values);
    }
    return looks;
}

} // namespace reljef::cast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
