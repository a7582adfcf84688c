// A picture of the sky, as a packet of rays sees it. Included once for each instruction set.
#if defined(RELJEF_PACKET_SKY_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELJEF_PACKET_SKY_INL_H
#undef RELJEF_PACKET_SKY_INL_H
#else
#define RELJEF_PACKET_SKY_INL_H
#endif

#include "engine/cast/packet/packet_light-inl.h"

HWY_BEFORE_NAMESPACE();
namespace reljef::cast::HWY_NAMESPACE {

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
    const Ints col = hn::ConvertTo(ints, places.col);
    const Ints row = hn::ConvertTo(ints, places.row);
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

} // namespace reljef::cast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
