// The search of a packet's rays for the relief of a detail texture, as
// shaders/relief/relief_linear.glsl. Included once for each instruction set.
#if defined(RELJEF_PACKET_RELIEF_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELJEF_PACKET_RELIEF_INL_H
#undef RELJEF_PACKET_RELIEF_INL_H
#else
#define RELJEF_PACKET_RELIEF_INL_H
#endif

#include <limits>

#include "engine/cast/packet/packet_points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace reljef::cast::HWY_NAMESPACE {

// Beyond the heights [0, 1]: rays begin above and end below them despite rounding.
constexpr float detail_margin = 1.0F / 4096.0F;
// Of the copies that a flat ray crosses; nearer relief hides what lies beyond.
constexpr float max_copies = 64.0F;

// A place in a texture, or a change of it, in copies.
struct CopyPlace {
    Floats u;
    Floats v;
};

// A ray through the relief: in samples, and its height in [0, 1].
struct ReliefRay {
    Floats col;
    Floats row;
    Floats height;
    Floats to_col; // to its end
    Floats to_row;
    Floats to_height;
};

// The heights of the relief at places in samples, which repeat.
HWY_INLINE Floats relief_height(const DetailPaint& detail, Floats col, Floats row) {
    const auto wrapped = [](Floats place, int samples) HWY_ATTR {
        const Floats count = all(static_cast<float>(samples));
        const Floats copy = hn::Floor(hn::Mul(place, all(1.0F / static_cast<float>(samples))));
        return hn::Min(hn::Max(hn::NegMulAdd(copy, count, place), hn::Zero(floats)), count);
    };
    const Floats x = wrapped(col, detail.samples.x);
    const Floats y = wrapped(row, detail.samples.y);
    const Ints cell_col = hn::Min(truncated(x), all(detail.samples.x - 1));
    const Ints cell_row = hn::Min(truncated(y), all(detail.samples.y - 1));
    const std::int32_t stride = detail.samples.x + 1;
    const Ints index = hn::Add(hn::Mul(cell_row, all(stride)), cell_col);
    const auto north = load_neighbours(floats, detail.heights, index);
    const auto south = load_neighbours(floats, detail.heights + stride, index);
    const Floats part = hn::Sub(x, hn::ConvertTo(floats, cell_col));
    return mixed(mixed(north.first, north.second, part), mixed(south.first, south.second, part),
                 hn::Sub(y, hn::ConvertTo(floats, cell_row)));
}

HWY_INLINE Floats above_relief(const DetailPaint& detail, const ReliefRay& ray, Floats part) {
    return hn::Sub(hn::MulAdd(part, ray.to_height, ray.height),
                   relief_height(detail, hn::MulAdd(part, ray.to_col, ray.col),
                                 hn::MulAdd(part, ray.to_row, ray.row)));
}

// Where rays cross the relief: between two parts of their ways, and how far they are above it
// there.
struct Bracket {
    Lanes found;
    Floats part;
    Floats over;
    Floats low_part;
    Floats under; // < 0
};

// Equal steps until one lies below the relief.
HWY_INLINE Bracket first_step_below(const DetailPaint& detail, const ReliefRay& ray, Floats steps,
                                    Lanes lanes) {
    const Floats zero = hn::Zero(floats);
    const Floats per_step = hn::Div(all(1.0F), steps);
    Bracket bracket{no_lanes(), zero, above_relief(detail, ray, zero), zero, zero};
    Lanes active = lanes;
    for (int i = 1; !hn::AllFalse(floats, active); ++i) {
        const Floats number = all(static_cast<float>(i));
        const Floats next = hn::Mul(number, per_step);
        const Floats now = above_relief(detail, ray, next);
        const Lanes below = hn::And(hn::Lt(now, zero), hn::Ge(bracket.over, zero));
        const Lanes hits = hn::And(active, below);
        bracket.found = hn::Or(bracket.found, hits);
        bracket.low_part = hn::IfThenElse(hits, next, bracket.low_part);
        bracket.under = hn::IfThenElse(hits, now, bracket.under);
        active = hn::AndNot(hits, active);
        bracket.part = hn::IfThenElse(active, next, bracket.part);
        bracket.over = hn::IfThenElse(active, now, bracket.over);
        active = hn::And(active, hn::Lt(number, steps));
    }
    return bracket;
}

// Bisection (Policarpo, Oliveira and Comba 2005), or the bracketed secant method (Risser, Shah and
// Pattanaik 2006).
HWY_INLINE Floats narrowed(const DetailPaint& detail, const ReliefRay& ray, Bracket bracket) {
    const Floats zero = hn::Zero(floats);
    for (int i = 0; i < detail.search.bisection_steps; ++i) {
        const Floats middle = hn::Mul(all(0.5F), hn::Add(bracket.part, bracket.low_part));
        const Lanes below = hn::Lt(above_relief(detail, ray, middle), zero);
        bracket.low_part = hn::IfThenElse(below, middle, bracket.low_part);
        bracket.part = hn::IfThenElse(below, bracket.part, middle);
    }
    if (detail.search.secant_steps == 0) {
        return bracket.low_part;
    }
    const auto guess = [](const Bracket& at) HWY_ATTR {
        return mixed(at.part, at.low_part, hn::Div(at.over, hn::Sub(at.over, at.under)));
    };
    for (int i = 1; i < detail.search.secant_steps; ++i) {
        const Floats part = guess(bracket);
        const Floats above = above_relief(detail, ray, part);
        const Lanes below = hn::Lt(above, zero);
        bracket.low_part = hn::IfThenElse(below, part, bracket.low_part);
        bracket.under = hn::IfThenElse(below, above, bracket.under);
        bracket.part = hn::IfThenElse(below, bracket.part, part);
        bracket.over = hn::IfThenElse(below, bracket.over, above);
    }
    return guess(bracket);
}

HWY_INLINE ReliefRay relief_ray(const DetailPaint& detail, const Vectors& to_eye, Floats lift,
                                const CopyPlace& place) {
    const Floats per_width = all(1.0F / detail.width);
    const Floats steepest = hn::Div(lift, hn::Max(to_eye[2], all(1e-30F)));
    const Floats copies = hn::Max(
        hn::Mul(hn::Max(hn::Abs(to_eye[0]), hn::Abs(to_eye[1])), hn::Mul(steepest, per_width)),
        all(1e-30F));
    const Floats way = hn::Mul(steepest, hn::Min(all(1.0F), hn::Div(all(max_copies), copies)));
    const auto axis = [&](Floats copy, Floats toward, int samples, Floats& from,
                          Floats& to) HWY_ATTR {
        const Floats count = all(static_cast<float>(samples));
        const Floats entry = hn::MulSub(hn::Sub(copy, hn::Floor(copy)), count, all(0.5F));
        const Floats shift = hn::Mul(hn::Mul(toward, way), hn::Mul(per_width, count));
        from = hn::MulAdd(shift, all(detail_margin), entry);
        to = hn::Mul(shift, all(-(1.0F + 2.0F * detail_margin)));
    };
    ReliefRay ray;
    axis(place.u, to_eye[0], detail.samples.x, ray.col, ray.to_col);
    axis(place.v, to_eye[1], detail.samples.y, ray.row, ray.to_row);
    ray.height = all(1.0F + detail_margin);
    ray.to_height = all(-(1.0F + 2.0F * detail_margin));
    return ray;
}

// Cosines of the rays' angles to the vertical. `lift`: height of 1, metres.
HWY_INLINE Floats uprightness(const DetailPaint& detail, const ReliefRay& ray, Floats lift) {
    const auto metres = [&](Floats samples, int count) HWY_ATTR {
        return hn::Mul(samples, all(detail.width / static_cast<float>(count)));
    };
    const Floats x = metres(ray.to_col, detail.samples.x);
    const Floats y = metres(ray.to_row, detail.samples.y);
    const Floats z = hn::Mul(ray.to_height, lift);
    const Floats square = hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)));
    const Floats cosine =
        hn::Div(hn::Abs(z), hn::Sqrt(hn::Max(square, all(std::numeric_limits<float>::min()))));
    return hn::Min(cosine, all(1.0F));
}

// Equal steps for each ray: more along the ground.
HWY_INLINE Floats steps_of(const DetailPaint& detail, const ReliefRay& ray, Floats lift) {
    const auto above = static_cast<float>(detail.search.steps_from_above);
    const auto along = static_cast<float>(detail.search.steps_along_ground);
    return hn::Ceil(mixed(all(along), all(above), uprightness(detail, ray, lift)));
}

// A place in samples.
struct SamplePlace {
    Floats col;
    Floats row;
};

// Shifts the place on the surface along the ray by the relief's depth there (Kaneko et al. 2001),
// as shaders/relief/relief_parallax.glsl.
HWY_INLINE SamplePlace shifted_place(const DetailPaint& detail, const ReliefRay& ray, Floats lift) {
    const float part = detail_margin / (1.0F + 2.0F * detail_margin);
    const SamplePlace entry{hn::MulAdd(all(part), ray.to_col, ray.col),
                            hn::MulAdd(all(part), ray.to_row, ray.row)};
    Floats per_height = hn::Div(all(1.0F), ray.to_height);
    if (detail.search.is_limited) { // Welsh 2004
        per_height = hn::Mul(per_height, uprightness(detail, ray, lift));
    }
    const auto at = [&](Floats height) HWY_ATTR {
        const Floats share = hn::Mul(hn::Sub(height, all(1.0F)), per_height);
        return SamplePlace{hn::MulAdd(share, ray.to_col, entry.col),
                           hn::MulAdd(share, ray.to_row, entry.row)};
    };
    Floats height = relief_height(detail, entry.col, entry.row);
    for (int i = 0; i < detail.search.iterations; ++i) {
        const SamplePlace place = at(height);
        const Floats there = relief_height(detail, place.col, place.row);
        height = hn::Mul(all(0.5F), hn::Add(height, there));
    }
    return at(height);
}

} // namespace reljef::cast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
