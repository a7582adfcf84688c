// Lines of equal height on the ground that a packet of rays hits. Included once for each
// instruction set.
#if defined(RELJEF_PACKET_CONTOURS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELJEF_PACKET_CONTOURS_INL_H
#undef RELJEF_PACKET_CONTOURS_INL_H
#else
#define RELJEF_PACKET_CONTOURS_INL_H
#endif

#include "engine/cast/packet/packet_grain-inl.h"

HWY_BEFORE_NAMESPACE();
namespace reljef::cast::HWY_NAMESPACE {

// The colour of ground with contours. `height`: true metres; `change`: its change from a pixel to
// its neighbours, metres. Every fifth line is bold. Crowded lines fade.
HWY_INLINE Color with_contours(const ContourPaint& paint, Floats height, Floats change,
                               const Color& lit) {
    const float interval = paint.interval;
    const Floats zero = hn::Zero(floats);
    const Lanes is_sloped = hn::Gt(change, hn::Mul(hn::Abs(height), all(height_rounding)));
    const Floats number = hn::Round(hn::Div(height, all(interval)));
    const Floats fifth = hn::Div(number, all(bold_every));
    const Lanes is_bold = hn::Lt(hn::Abs(hn::Sub(fifth, hn::Round(fifth))), all(0.5F / bold_every));
    const Floats some = hn::IfThenElse(is_sloped, hn::Mul(change, all(paint.scale)), all(1.0F));
    const Floats off = hn::Abs(hn::NegMulAdd(number, all(interval), height));
    const Floats pixels = hn::Div(off, some);
    const auto either = [&](float bold, float thin)
                            HWY_ATTR { return hn::IfThenElse(is_bold, all(bold), all(thin)); };
    const Floats apart = hn::Div(either(bold_every * interval, interval), some);
    const Floats line =
        hn::Min(hn::Max(hn::Sub(either(bold_reach, thin_reach), pixels), zero), all(1.0F));
    const Floats ink = hn::IfThenElseZero(
        is_sloped, hn::Mul(line, smooth_step(crowded_pixels, apart_pixels, apart)));
    return scaled(lit, hn::NegMulAdd(ink, either(bold_ink, thin_ink), all(1.0F)));
}

} // namespace reljef::cast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
