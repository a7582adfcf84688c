// The light that the hits of a packet reflect. Included once for each instruction set.
#if defined(RELJEF_PACKET_LIGHT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELJEF_PACKET_LIGHT_INL_H
#undef RELJEF_PACKET_LIGHT_INL_H
#else
#define RELJEF_PACKET_LIGHT_INL_H
#endif

#include <array>

#include "engine/cast/packet/packet_sun-inl.h"

HWY_BEFORE_NAMESPACE();
namespace reljef::cast::HWY_NAMESPACE {

// Linear light.
struct Color {
    Floats r;
    Floats g;
    Floats b;
};

HWY_INLINE Color all(glm::vec3 color) {
    return {all(color.r), all(color.g), all(color.b)};
}

HWY_INLINE Color scaled(const Color& color, Floats by) {
    return {hn::Mul(color.r, by), hn::Mul(color.g, by), hn::Mul(color.b, by)};
}

HWY_INLINE Color chosen(Lanes lanes, const Color& yes, const Color& no) {
    return {hn::IfThenElse(lanes, yes.r, no.r), hn::IfThenElse(lanes, yes.g, no.g),
            hn::IfThenElse(lanes, yes.b, no.b)};
}

HWY_INLINE Color mixed(const Color& a, const Color& b, Floats part) {
    return {mixed(a.r, b.r, part), mixed(a.g, b.g, part), mixed(a.b, b.b, part)};
}

// Cubic polynomials interpolate at Chebyshev's places; the errors are relative to the result's
// range.
HWY_INLINE Floats cubic(Floats x, float c0, float c1, float c2, float c3) {
    return hn::MulAdd(hn::MulAdd(hn::MulAdd(all(c3), x, all(c2)), x, all(c1)), x, all(c0));
}

// log2(x) within 8.3e-4, for positive x.
HWY_INLINE Floats log2_of(Floats x) {
    const Ints bits = hn::BitCast(ints, x);
    const Ints exponent = hn::Sub(hn::ShiftRight<23>(bits), all(127));
    const Floats mantissa =
        hn::BitCast(floats, hn::Or(hn::And(bits, all(0x007FFFFF)), all(std::int32_t{0x3F800000})));
    return hn::Add(hn::ConvertTo(floats, exponent),
                   cubic(mantissa, -2.1362321F, 3.0111622F, -1.0268049F, 0.15270028F));
}

// 2^x within 1.2e-4, for x <= 0; 0 below the smallest float.
HWY_INLINE Floats exp2_of(Floats x) {
    const Floats smallest = all(-126.0F);
    const Floats clamped = hn::Max(x, smallest);
    const Floats whole = hn::Floor(clamped);
    const Floats power =
        cubic(hn::Sub(clamped, whole), 0.99990029F, 0.69632477F, 0.22469316F, 0.07896726F);
    return hn::IfThenElseZero(hn::Gt(x, smallest), hn::Mul(power, size_of(truncated(whole))));
}

// The three times 10 bits of a texel, [0, 1023]; its other two bits are 0.
HWY_INLINE std::array<Floats, 3> channels_of(Ints texel) {
    const auto channel = [](Ints bits) HWY_ATTR {
        return hn::ConvertTo(floats, hn::And(bits, all(std::int32_t{1023})));
    };
    return {channel(texel), channel(hn::ShiftRight<10>(texel)),
            hn::ConvertTo(floats, hn::ShiftRight<20>(texel))};
}

// What texels hold.
struct SquareRoots {
    static HWY_INLINE Floats value(Floats channel) { return hn::Mul(channel, channel); }
};
struct Linear {
    static HWY_INLINE Floats value(Floats channel) { return channel; }
};

// Adds a texel, times its weight.
template <class Encoding> HWY_INLINE void add_texel(Ints texel, Floats weight, Color& sum) {
    const auto [r, g, b] = channels_of(texel);
    sum.r = hn::MulAdd(Encoding::value(r), weight, sum.r);
    sum.g = hn::MulAdd(Encoding::value(g), weight, sum.g);
    sum.b = hn::MulAdd(Encoding::value(b), weight, sum.b);
}

// Four texels around a place: the upper left one, the one below it, and how far the place is from
// these to the next ones.
struct TexelPlaces {
    Ints index;
    Ints below;
    Floats part_col; // [0, 1]
    Floats part_row;
};

// Adds the bilinear colour, times its weight.
template <class Encoding>
HWY_INLINE void add_bilinear(const std::uint32_t* texels, const TexelPlaces& places, Floats weight,
                             Color& sum) {
    const auto* const first = reinterpret_cast<const std::int32_t*>(texels);
    const Floats right = hn::Mul(weight, places.part_col);
    const Floats left = hn::Sub(weight, right);
    const Floats right_below = hn::Mul(right, places.part_row);
    const Floats left_below = hn::Mul(left, places.part_row);
    const auto above = load_neighbours(ints, first, places.index);
    const auto under = load_neighbours(ints, first, places.below);
    add_texel<Encoding>(above.first, hn::Sub(left, left_below), sum);
    add_texel<Encoding>(above.second, hn::Sub(right, right_below), sum);
    add_texel<Encoding>(under.first, left_below, sum);
    add_texel<Encoding>(under.second, right_below, sum);
}

// Places on the map, texels of level 0 from its corner.
struct MapPlaces {
    Floats col;
    Floats row;
};

// Where the texels of each lane's level begin.
HWY_INLINE Ints begin_of(const TilePaint& paint, Ints level) {
#if HWY_TARGET == HWY_AVX3
    static_assert(max_paint_levels >= lane_count);
    if (paint.level_count <= lane_count) {
        return hn::TableLookupLanes(hn::LoadU(ints, paint.begin.data()),
                                    hn::IndicesFromVec(ints, level));
    }
#endif
    return hn::GatherIndex(ints, paint.begin.data(), level);
}

// Adds the bilinear colours of each lane's level, times their weights.
template <class Encoding>
HWY_INLINE void add_level(const TilePaint& paint, const MapPlaces& places, Ints level,
                          Floats weight, Color& sum) {
    const Floats texels = size_of(hn::Neg(level)); // a texel of level 0
    const Ints last_col = hn::Shr(all(paint.last.x), level);
    const Ints last_row = hn::Shr(all(paint.last.y), level);
    const auto inside = [&](Floats place, Ints last) HWY_ATTR {
        const Floats texel = hn::MulSub(place, texels, all(0.5F));
        return hn::Min(hn::Max(texel, hn::Zero(floats)), hn::ConvertTo(floats, last));
    };
    const Floats u = inside(places.col, last_col);
    const Floats v = inside(places.row, last_row);
    const Ints col = truncated(u);
    const Ints row = truncated(v);
    const Ints stride = hn::Add(last_col, all(2));
    const Ints index = hn::Add(hn::Add(hn::Mul(row, stride), col), begin_of(paint, level));
    add_bilinear<Encoding>(paint.texels,
                           {index, hn::Add(index, stride), hn::Sub(u, hn::ConvertTo(floats, col)),
                            hn::Sub(v, hn::ConvertTo(floats, row))},
                           weight, sum);
}

// The values of the map: bilinear in the two levels nearest to each lane's.
template <class Encoding>
HWY_INLINE Color map_sum(const TilePaint& paint, const PacketHits& hits, Floats level) {
    const auto place = [&](Ints cell, Floats part, int axis) HWY_ATTR {
        const Floats sample = hn::Add(hn::ConvertTo(floats, cell), part);
        return hn::MulAdd(sample, all(paint.texels_per_sample[axis]),
                          all(paint.first[axis] + 0.5F));
    };
    const MapPlaces places{place(hits.col, hits.col_part, 0), place(hits.row, hits.row_part, 1)};
    const Floats seen = hn::IfThenElseZero(hits.found, level);
    const Ints fine = truncated(seen);
    const Floats coarse_part = hn::Sub(seen, hn::ConvertTo(floats, fine));
    Color sum = all(glm::vec3(0.0F));
    add_level<Encoding>(paint, places, fine, hn::Sub(all(1.0F), coarse_part), sum);
    if (!hn::AllTrue(floats, hn::Eq(coarse_part, hn::Zero(floats)))) {
        const Ints coarse = hn::Min(hn::Add(fine, all(1)), all(paint.level_count - 1));
        add_level<Encoding>(paint, places, coarse, coarse_part, sum);
    }
    return sum;
}

HWY_INLINE Color map_color(const TilePaint& paint, const PacketHits& hits, Floats level) {
    return scaled(map_sum<SquareRoots>(paint, hits, level), all(1.0F / (1023.0F * 1023.0F)));
}

// The texels of map_color() that a hit's colour depends on.
HWY_INLINE void count_texels(const PacketHits& hits, Floats level, Work& work) {
    constexpr int texels_of_level = 4;
    work.tap(hits.found, texels_of_level);
    const Lanes between = hn::Gt(level, hn::Floor(level));
    work.tap(hn::And(hits.found, between), texels_of_level);
}

// Of the hits. `beside_meshes(lanes)`: those from which no mesh hides the sun.
template <class Mode, class BesideMeshes>
HWY_INLINE Color lit_color(const BlockJob& job, const PacketHits& hits, Floats level,
                           const BesideMeshes& beside_meshes, Work& work) {
    Color lit = map_color(*job.paint, hits, level);
    if constexpr (Mode::counts) {
        count_texels(hits, level, work);
    }
    if (job.sun == nullptr) {
        return lit;
    }
    if constexpr (Mode::counts) {
        count_texels(hits, level, work);
    }
    const Color sun = map_color(*job.sun, hits, level);
    const Lanes sunny = beside_meshes(seen_by_sun<Mode>(job, hits, work));
    if (!hn::AllFalse(floats, sunny)) {
        const auto add = [&](Floats part, Floats& channel) HWY_ATTR {
            channel = hn::Add(channel, hn::IfThenElseZero(sunny, part));
        };
        add(sun.r, lit.r);
        add(sun.g, lit.g);
        add(sun.b, lit.b);
    }
    return lit;
}

} // namespace reljef::cast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
