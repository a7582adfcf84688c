// Walls of buildings that a packet of rays hits. Included once for each instruction set.
#if defined(RELJEF_PACKET_FACADES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELJEF_PACKET_FACADES_INL_H
#undef RELJEF_PACKET_FACADES_INL_H
#else
#define RELJEF_PACKET_FACADES_INL_H
#endif

#include <cmath>

#include "engine/cast/packet/packet_points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace reljef::cast::HWY_NAMESPACE {

HWY_INLINE Floats clamped(Floats x, float low, float high) {
    return hn::Min(hn::Max(x, all(low)), all(high));
}

// The integral of the periodic stripes from `begin` to `end`, parts of a period.
HWY_INLINE Floats stripes_until(Floats x, float begin, float end) {
    const Floats whole = hn::Floor(x);
    const Floats part = clamped(hn::Sub(hn::Sub(x, whole), all(begin)), 0.0F, end - begin);
    return hn::MulAdd(whole, all(end - begin), part);
}

// A place along a wall, and the width of a pixel there; both in periods of its windows.
struct Along {
    Floats middle;
    Floats width;

    // The share of stripes in the pixel.
    HWY_INLINE Floats share(float begin, float end) const {
        const Floats half = hn::Mul(all(0.5F), width);
        const Floats until = stripes_until(hn::Add(middle, half), begin, end);
        return hn::Div(hn::Sub(until, stripes_until(hn::Sub(middle, half), begin, end)), width);
    }
};

// The places of values in view::FacadeTexels.
enum WallValue : std::int32_t {
    begin_col_value,
    begin_row_value,
    windows_a_col_value,
    windows_a_row_value,
    first_window_value,
    eaves_value,
    storeys_value, // in a metre
    window_metres_value,
    outward_x_value,
    outward_y_value,
    facing_sun_value,
    top_value,
    red_value,
    green_value,
    blue_value,
    foot_value
};
static_assert(foot_value + 1 == FacadePaint::wall_values);

// Values of the walls near hits.
struct WallNear {
    const float* values;
    Ints first;

    HWY_INLINE Floats operator()(WallValue index) const {
        return hn::GatherIndex(floats, values,
                               hn::Add(first, all(static_cast<std::int32_t>(index))));
    }
};

// The albedo of a wall. `is_high`: above the windows.
HWY_INLINE Color wall_albedo(const Along& u, const Along& v, const Color& plaster, Lanes is_high) {
    const auto low = [&](Floats share) HWY_ATTR { return hn::IfThenZeroElse(is_high, share); };
    const Floats frames =
        low(hn::Mul(u.share(frame_begin, frame_end), v.share(frame_top, frame_bottom)));
    const Floats panes = low(hn::Mul(
        hn::Add(u.share(left_pane_begin, left_pane_end), u.share(right_pane_begin, right_pane_end)),
        v.share(pane_top, pane_bottom)));
    const Floats ledges =
        low(hn::MulAdd(u.share(sill_begin, sill_end), v.share(sill_top, sill_bottom),
                       v.share(0.0F, ledge_bottom)));
    const Floats of_plaster =
        hn::NegMulAdd(ledges, all(1.0F - ledge_light), hn::Sub(all(1.0F), frames));
    const Floats of_frames = hn::Sub(frames, panes);
    const auto channel = [&](Floats wall, float frame, float pane) HWY_ATTR {
        return hn::MulAdd(wall, of_plaster,
                          hn::MulAdd(of_frames, all(frame), hn::Mul(panes, all(pane))));
    };
    return {channel(plaster.r, frame_red, pane_red), channel(plaster.g, frame_green, pane_green),
            channel(plaster.b, frame_blue, pane_blue)};
}

// The sample nearest to hits.
HWY_INLINE Ints nearest_sample(const FacadePaint& paint, const PacketHits& hits) {
    const auto nearest = [](Ints cell, Floats part)
                             HWY_ATTR { return hn::Add(cell, rounded(part)); };
    return hn::Add(hn::Mul(nearest(hits.row, hits.row_part), all(paint.stride)),
                   nearest(hits.col, hits.col_part));
}

// A normal, of any length, without the exaggeration of heights.
HWY_INLINE std::array<Floats, 3> true_normal(const std::array<Floats, 3>& drawn,
                                             float exaggeration) {
    return {drawn[0], drawn[1], hn::Mul(drawn[2], all(exaggeration))};
}

// Monotonic: numbers are compared by it without roots.
HWY_INLINE Floats signed_square(Floats number) {
    return hn::Mul(number, hn::Abs(number));
}
HWY_INLINE float signed_square(float number) {
    return number * std::abs(number);
}

// Whether normals are farther from vertical than the angle of this cosine.
HWY_INLINE Lanes lean_beyond(const std::array<Floats, 3>& normal, float cosine) {
    return hn::Lt(signed_square(normal[2]),
                  hn::Mul(dot(normal, normal), all(signed_square(cosine))));
}

// The lanes whose ground faces as their walls do.
HWY_INLINE Lanes face_as_walls(const WallNear& wall, const std::array<Floats, 3>& normal) {
    const Floats leaning =
        hn::MulAdd(wall(outward_x_value), normal[0], hn::Mul(wall(outward_y_value), normal[1]));
    const Floats level_square = hn::MulAdd(normal[0], normal[0], hn::Mul(normal[1], normal[1]));
    const Floats min_square =
        hn::IfThenElse(lean_beyond(normal, upright_cosine), all(signed_square(corner_leaning)),
                       all(signed_square(wall_leaning)));
    return hn::Gt(signed_square(leaning), hn::Mul(level_square, min_square));
}

// The walls that hits lie on.
struct WallHits {
    Lanes found;
    WallNear wall;
    Floats shadow; // true height below which the sun is hidden
};

// `height`: true metres.
HWY_INLINE WallHits wall_hits(const FacadePaint& paint, const TilePaint& tile,
                              const PacketHits& hits, Floats height) {
    const std::array<Floats, 3> normal = true_normal(normal_of(tile, hits), paint.exaggeration);
    const Lanes steep = hn::And(hits.found, lean_beyond(normal, wall_cosine));
    WallHits on{steep, {paint.walls, hn::Zero(ints)}, hn::Zero(floats)};
    if (hn::AllFalse(floats, steep)) {
        return on;
    }
    const Ints index = hn::IfThenElseZero(hn::RebindMask(ints, steep), nearest_sample(paint, hits));
    const Ints values = hn::Add(index, index);
    const Floats number = hn::GatherIndex(floats, paint.samples, values);
    on.found = hn::And(steep, hn::Gt(number, hn::Zero(floats)));
    if (hn::AllFalse(floats, on.found)) {
        return on;
    }
    const Floats wall = hn::IfThenElseZero(on.found, hn::Sub(number, all(1.0F)));
    on.wall.first = hn::Mul(truncated(wall), all(FacadePaint::wall_values));
    on.shadow = hn::GatherIndex(floats, paint.samples + 1, values);
    const Lanes below_top = hn::Le(height, on.wall(top_value));
    on.found = hn::And(on.found, hn::And(face_as_walls(on.wall, normal), below_top));
    return on;
}

// The extent of pixels on walls, drawn metres.
struct PixelOnWall {
    Floats along;
    Floats up;
};

HWY_INLINE PixelOnWall pixel_on_wall(const FacadePaint& paint, const GroundPlace& place,
                                     const WallNear& wall) {
    const std::array<Floats, 2> out{wall(outward_x_value), wall(outward_y_value)};
    const std::array<Floats, 3> view = turned(paint.turn, place.view);
    const Floats across = hn::MulAdd(out[0], view[0], hn::Mul(out[1], view[1]));
    const Floats along = hn::MulSub(out[0], view[1], hn::Mul(out[1], view[0]));
    const Floats facing =
        hn::Max(hn::Abs(across), hn::Mul(place.view_length, all(flattest_facing)));
    const Floats pixel =
        hn::MulAdd(place.distance, all(paint.metres_a_pixel.y), all(paint.metres_a_pixel.x));
    const auto extent = [&](Floats of_view) HWY_ATTR {
        const Floats longer = hn::Div(of_view, facing);
        return hn::Mul(pixel, hn::Sqrt(hn::MulAdd(longer, longer, all(1.0F))));
    };
    return {extent(along), extent(view[2])};
}

HWY_INLINE Along along_wall(const PacketHits& hits, const WallNear& wall,
                            const PixelOnWall& pixel) {
    const auto from_begin = [&](Ints cell, Floats part, Floats begin) HWY_ATTR {
        return hn::Add(hn::Sub(hn::ConvertTo(floats, cell), begin), part);
    };
    const Floats col = from_begin(hits.col, hits.col_part, wall(begin_col_value));
    const Floats row = from_begin(hits.row, hits.row_part, wall(begin_row_value));
    const Floats windows =
        hn::MulAdd(col, wall(windows_a_col_value),
                   hn::MulAdd(row, wall(windows_a_row_value), wall(first_window_value)));
    const Floats width = hn::Div(pixel.along, wall(window_metres_value));
    return {windows, hn::Max(width, all(narrowest_pixel))};
}

HWY_INLINE Along down_wall(const FacadePaint& paint, Floats height, const WallNear& wall,
                           const PixelOnWall& pixel) {
    const Floats storeys = hn::Mul(hn::Sub(wall(eaves_value), height), wall(storeys_value));
    const Floats width =
        hn::Mul(pixel.up, hn::Mul(wall(storeys_value), all(1.0F / paint.exaggeration)));
    return {storeys, hn::Max(width, all(narrowest_pixel))};
}

// Shares of the light of a free wall that faces the sun.
struct WallLight {
    Floats sun;
    Floats sky;
};

// `beside_meshes(lanes)`: those from which no mesh hides the sun.
template <class BesideMeshes>
HWY_INLINE WallLight light_on_walls(const WallHits& on, Floats height,
                                    const BesideMeshes& beside_meshes) {
    const Floats foot = on.wall(foot_value);
    const Floats high = hn::Max(hn::Sub(on.wall(eaves_value), foot), all(1.0F));
    const Floats risen = clamped(hn::Div(hn::Sub(height, foot), high), 0.0F, 1.0F);
    const Floats above_shadow = hn::Mul(hn::Sub(height, on.shadow), all(1.0F / shadow_border));
    const Floats sun = hn::Mul(on.wall(facing_sun_value), clamped(above_shadow, 0.0F, 1.0F));
    const Lanes sunny = hn::And(on.found, hn::Gt(sun, hn::Zero(floats)));
    return {hn::IfThenElseZero(beside_meshes(sunny), sun),
            hn::MulAdd(risen, all(1.0F - sky_at_foot), all(sky_at_foot))};
}

// The light of points on upright walls; not inline, so that walls without lamps do not pay for it.
HWY_NOINLINE Color points_on_walls(const BlockPaint& paint, const GroundPlace& place,
                                   const WallNear& wall) {
    const glm::vec2 back(paint.facades->turn.x, -paint.facades->turn.y);
    return light_of_points(
        paint, place.from_eye,
        turned(back, {wall(outward_x_value), wall(outward_y_value), hn::Zero(floats)}));
}

// The colour of ground with façades. `height`: true metres.
template <class BesideMeshes>
HWY_INLINE Color with_facades(const BlockJob& job, const BlockPaint& block,
                              const GroundPlace& place, const PacketHits& hits, Floats height,
                              const Color& lit, const BesideMeshes& beside_meshes) {
    const FacadePaint& paint = *block.facades;
    const WallHits on = wall_hits(paint, *job.paint, hits, height);
    if (hn::AllFalse(floats, on.found)) {
        return lit;
    }
    const WallNear& wall = on.wall;
    const PixelOnWall pixel = pixel_on_wall(paint, place, wall);
    const Color albedo = wall_albedo(
        along_wall(hits, wall, pixel), down_wall(paint, height, wall, pixel),
        {wall(red_value), wall(green_value), wall(blue_value)}, hn::Gt(height, wall(eaves_value)));
    const WallLight light = light_on_walls(on, height, beside_meshes);
    const auto channel = [&](Floats of_wall, float sun, float sky, Floats ground) HWY_ATTR {
        const Floats all_light = hn::MulAdd(light.sun, all(sun), hn::Mul(light.sky, all(sky)));
        return hn::IfThenElse(on.found, hn::Mul(of_wall, all_light), ground);
    };
    const Color shown{channel(albedo.r, paint.sun.r, paint.sky.r, lit.r),
                      channel(albedo.g, paint.sun.g, paint.sky.g, lit.g),
                      channel(albedo.b, paint.sun.b, paint.sky.b, lit.b)};
    if (job.albedo == nullptr || block.point_lights.empty()) {
        return shown;
    }
    const Color more = added(shown, product(albedo, points_on_walls(block, place, wall)));
    return {hn::IfThenElse(on.found, more.r, shown.r), hn::IfThenElse(on.found, more.g, shown.g),
            hn::IfThenElse(on.found, more.b, shown.b)};
}

} // namespace reljef::cast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
