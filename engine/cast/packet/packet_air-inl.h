// The air and the sky that a packet of rays passes. Included once for each instruction set.
#if defined(RELJEF_PACKET_AIR_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELJEF_PACKET_AIR_INL_H
#undef RELJEF_PACKET_AIR_INL_H
#else
#define RELJEF_PACKET_AIR_INL_H
#endif

#include "engine/cast/packet/packet_grain-inl.h"
#include "engine/cast/packet/packet_light-inl.h"

HWY_BEFORE_NAMESPACE();
namespace reljef::cast::HWY_NAMESPACE {

// World directions of the rays, and their length per t.
struct ViewRays {
    Floats x;
    Floats y;
    Floats z;
    Floats length;
};

HWY_INLINE ViewRays view_rays(const BlockPaint& paint, const PixelOffsets& pixels) {
    ViewRays view{pixels.of(paint.view, 0), pixels.of(paint.view, 1), pixels.of(paint.view, 2),
                  hn::Zero(floats)};
    view.length =
        hn::Sqrt(hn::MulAdd(view.x, view.x, hn::MulAdd(view.y, view.y, hn::Mul(view.z, view.z))));
    return view;
}

// Unit vectors of the view rays: their rise, and the cosine of the angle to the sun.
struct ViewAngles {
    Floats rise;
    Floats climb; // away from the base of the air
    Floats to_sun;
};

HWY_INLINE ViewAngles angles_of(const BlockPaint& paint, const ViewRays& view) {
    const Floats per_length = hn::Div(all(1.0F), view.length);
    const auto along = [&](glm::vec3 axis) HWY_ATTR {
        return hn::Mul(hn::MulAdd(view.x, all(axis.x),
                                  hn::MulAdd(view.y, all(axis.y), hn::Mul(view.z, all(axis.z)))),
                       per_length);
    };
    return {hn::Mul(view.z, per_length), along(paint.up), along(paint.to_sun)};
}

HWY_INLINE Color with_added(const Color& color, glm::vec3 added, Floats share) {
    return {hn::MulAdd(all(added.r), share, color.r), hn::MulAdd(all(added.g), share, color.g),
            hn::MulAdd(all(added.b), share, color.b)};
}

// Forward scattering.
HWY_INLINE Color with_glow(const BlockPaint& paint, const ViewAngles& angles, const Color& color) {
    if (!paint.has_sun) {
        return color;
    }
    const Floats toward = hn::Max(angles.to_sun, hn::Zero(floats));
    const Floats square = hn::Mul(toward, toward);
    const Floats fourth = hn::Mul(square, square);
    return with_added(color, paint.glow, hn::Mul(fourth, fourth));
}

// A colour behind metres of air as dense as at the base.
HWY_INLINE Color behind_air(const BlockPaint& paint, const ViewAngles& angles, const Color& color,
                            Floats air) {
    constexpr float log2_e = 1.4426950F;
    const auto left = [&](float extinction)
                          HWY_ATTR { return exp2_of(hn::Mul(air, all(-log2_e * extinction))); };
    const Color haze = with_glow(paint, angles, all(paint.horizon));
    return {mixed(haze.r, color.r, left(paint.extinction.r)),
            mixed(haze.g, color.g, left(paint.extinction.g)),
            mixed(haze.b, color.b, left(paint.extinction.b))};
}

// A colour behind air whose density falls exponentially with height (Koschmieder 1924).
HWY_INLINE Color through_air(const BlockPaint& paint, const ViewAngles& angles, const Color& color,
                             Floats metres) {
    constexpr float log2_e = 1.4426950F;
    const Floats eye_above = all(paint.eye_above);
    const Floats eye_density = all(paint.eye_density);
    const Floats climb = hn::MulAdd(all(paint.bend), metres, angles.climb);
    const Floats above = hn::Max(hn::MulAdd(climb, metres, eye_above), hn::Zero(floats));
    const Floats density = exp2_of(hn::Mul(above, all(-log2_e * paint.per_height)));
    const Floats rise = hn::Mul(hn::Sub(above, eye_above), all(paint.per_height));
    const Floats even = hn::Mul(all(0.5F), hn::Add(eye_density, density));
    const Floats mean = hn::IfThenElse(hn::Lt(hn::Abs(rise), all(0.1F)), even,
                                       hn::Div(hn::Sub(eye_density, density), rise));
    return behind_air(paint, angles, color, hn::Mul(mean, metres));
}

// Texels from the corner of the stacked faces.
struct FacePlaces {
    Floats col;
    Floats row;
};

// As material::SkyPicture::color(). Directions of any length above 0.
HWY_INLINE FacePlaces face_places(const SkyPaint& sky, Floats x, Floats y, Floats z) {
    const Lanes along_x = hn::Ge(hn::Abs(x), hn::Abs(y));
    const Floats level = hn::IfThenElse(along_x, x, y);
    const Lanes upright = hn::Lt(hn::Abs(level), hn::Abs(z));
    const Floats axis = hn::IfThenElse(upright, z, level);
    const Floats across =
        hn::IfThenElse(upright, x, hn::IfThenElse(along_x, y, x)); // the first other axis
    const Floats up = hn::IfThenElse(upright, y, z);
    const Floats first =
        hn::IfThenElse(upright, all(4.0F), hn::IfThenElseZero(hn::Not(along_x), all(2.0F)));
    const Floats face =
        hn::Add(first, hn::IfThenElseZero(hn::Lt(axis, hn::Zero(floats)), all(1.0F)));
    const Floats half = all(0.5F * static_cast<float>(sky.side));
    const Floats per_axis = hn::Div(half, hn::Abs(axis));
    const Floats middle = hn::Add(half, all(0.5F)); // a texel of border less half of one
    return {
        hn::MulAdd(across, per_axis, middle),
        hn::MulAdd(face, all(static_cast<float>(sky.side + 2)), hn::MulAdd(up, per_axis, middle))};
}

HWY_INLINE Color sky_picture_color(const SkyPaint& sky, Floats x, Floats y, Floats z) {
    const auto turned = [&](int row) HWY_ATTR {
        const glm::mat3& turn = sky.picture_from_world;
        return hn::MulAdd(all(turn[0][row]), x,
                          hn::MulAdd(all(turn[1][row]), y, hn::Mul(all(turn[2][row]), z)));
    };
    const FacePlaces places = face_places(sky, turned(0), turned(1), turned(2));
    const Ints col = truncated(places.col);
    const Ints row = truncated(places.row);
    const Ints stride = all(sky.side + 2);
    const Ints index = hn::Add(hn::Mul(row, stride), col);
    Color sum = all(glm::vec3(0.0F));
    add_bilinear<SquareRoots>(sky.texels,
                              {index, hn::Add(index, stride),
                               hn::Sub(places.col, hn::ConvertTo(floats, col)),
                               hn::Sub(places.row, hn::ConvertTo(floats, row))},
                              all(1.0F), sum);
    return scaled(sum, all(1.0F / (1023.0F * 1023.0F)));
}

HWY_INLINE Color above_horizon(const BlockPaint& paint, const ViewRays& view,
                               const ViewAngles& angles) {
    if (paint.sky != nullptr) {
        return sky_picture_color(*paint.sky, view.x, view.y, view.z);
    }
    const Floats zero = hn::Zero(floats);
    const Floats height = hn::Max(angles.rise, zero);
    const Floats share =
        hn::Div(hn::Mul(height, all(1.0F + paint.curve)), hn::Add(height, all(paint.curve)));
    const Color sky = with_glow(paint, angles, mixed(all(paint.horizon), all(paint.zenith), share));
    if (!paint.has_sun) {
        return sky;
    }
    constexpr float disc_begin = 0.99985F;
    constexpr float disc_width = 0.0001F;
    return with_added(sky, paint.sun, smooth_rise(disc_begin, disc_width, angles.to_sun));
}

HWY_INLINE Color plane_color(const BlockPaint& paint, const ViewAngles& angles) {
    if (!paint.has_air) {
        return all(paint.plane);
    }
    const Floats fall = hn::Max(hn::Neg(angles.climb), all(1e-9F)); // lanes above show no plane
    const Floats beyond = hn::MulSub(fall, fall, all(4.0F * paint.bend * paint.eye_above));
    const Floats twice = hn::Add(fall, hn::Sqrt(hn::Max(beyond, hn::Zero(floats))));
    return behind_air(paint, angles, all(paint.plane), hn::Div(all(2.0F * paint.plane_air), twice));
}

HWY_INLINE Floats fraction_of(Floats x) {
    return hn::Sub(x, hn::Floor(x));
}

// As in the shader of the sky.
HWY_INLINE Color dithered(const BlockPaint& paint, const PixelOffsets& pixels, const Color& color) {
    constexpr float repeat = 64.0F;
    const auto place_of = [](Floats pixel) HWY_ATTR {
        return hn::MulSub(fraction_of(hn::Mul(hn::Floor(pixel), all(1.0F / repeat))), all(repeat),
                          hn::Zero(floats));
    };
    const Floats x = place_of(hn::Add(pixels.right, all(paint.from_corner.x)));
    const Floats y = place_of(hn::Sub(all(paint.from_corner.y), pixels.down));
    const Floats inner = fraction_of(hn::MulAdd(x, all(0.06711056F), hn::Mul(y, all(0.00583715F))));
    const Floats noise = fraction_of(hn::Mul(all(52.9829189F), inner));
    const Floats scale = hn::Mul(hn::Sub(noise, all(0.5F)), all(2.1F / 255.0F));
    const auto moved = [&](Floats channel) HWY_ATTR {
        return hn::MulAdd(scale, hn::Sqrt(hn::Max(channel, hn::Zero(floats))), channel);
    };
    return {moved(color.r), moved(color.g), moved(color.b)};
}

HWY_INLINE Color sky_color(const BlockPaint& paint, const PixelOffsets& pixels,
                           const ViewRays& view) {
    if (!paint.has_sky) {
        return all(glm::vec3(0.0F));
    }
    const ViewAngles angles = angles_of(paint, view);
    const Lanes below = hn::Lt(angles.climb, hn::Zero(floats));
    if (paint.plane_air <= 0.0F || hn::AllFalse(floats, below)) {
        return dithered(paint, pixels, above_horizon(paint, view, angles));
    }
    return dithered(paint, pixels,
                    chosen(below, plane_color(paint, angles), above_horizon(paint, view, angles)));
}

} // namespace reljef::cast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
