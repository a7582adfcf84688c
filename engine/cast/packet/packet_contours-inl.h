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
// its neighbours, metres. Each fifth line is bold. Crowded lines fade.
HWY_INLINE Color with_contours(float interval, Floats height, Floats change, const Color& lit) {
    constexpr float bold_every = 5.0F;
    constexpr float flattest = 0x1p-16F; // intervals a pixel
    const Floats zero = hn::Zero(floats);
    const Floats steps = hn::Mul(height, all(1.0F / interval));
    const Floats number = hn::Round(steps);
    const Floats fifth = hn::Mul(number, all(1.0F / bold_every));
    const Lanes is_bold = hn::Lt(hn::Abs(hn::Sub(fifth, hn::Round(fifth))), all(0.5F / bold_every));
    const Floats per_pixel = hn::Max(hn::Mul(change, all(1.0F / interval)), all(flattest));
    const Floats pixels = hn::Div(hn::Abs(hn::Sub(steps, number)), per_pixel);
    const auto either = [&](float bold, float thin)
                            HWY_ATTR { return hn::IfThenElse(is_bold, all(bold), all(thin)); };
    const Floats apart = hn::Div(either(bold_every, 1.0F), per_pixel);
    const Floats line = hn::Min(hn::Max(hn::Sub(either(1.3F, 1.0F), pixels), zero), all(1.0F));
    const Floats ink = hn::IfThenElseZero(hn::Gt(per_pixel, all(flattest)),
                                          hn::Mul(line, smooth_step(3.0F, 8.0F, apart)));
    return scaled(lit, hn::NegMulAdd(ink, either(0.6F, 0.4F), all(1.0F)));
}

} // namespace reljef::cast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
