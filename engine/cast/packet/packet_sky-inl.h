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
    const Floats part_col = hn::Sub(places.col, hn::ConvertTo(floats, col));
    const Floats part_row = hn::Sub(places.row, hn::ConvertTo(floats, row));
    const Ints stride = all(sky.side + 2);
    const Ints index = hn::Add(hn::Mul(row, stride), col);
    const Ints below = hn::Add(index, stride);
    const auto* const first = reinterpret_cast<const std::int32_t*>(sky.texels);
    const Floats left = hn::Sub(all(1.0F), part_col);
    const Floats right_below = hn::Mul(part_col, part_row);
    const Floats left_below = hn::Mul(left, part_row);
    Color sum = all(glm::vec3(0.0F));
    const auto above = load_neighbours(ints, first, index);
    const auto under = load_neighbours(ints, first, below);
    add_texel<SquareRoots>(above.first, hn::Sub(left, left_below), sum);
    add_texel<SquareRoots>(above.second, hn::Sub(part_col, right_below), sum);
    add_texel<SquareRoots>(under.first, left_below, sum);
    add_texel<SquareRoots>(under.second, right_below, sum);
    return scaled(sum, all(1.0F / (1023.0F * 1023.0F)));
}

} // namespace reljef::cast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
