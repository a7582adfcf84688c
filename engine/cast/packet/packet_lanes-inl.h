// The lanes of vectors, and the arithmetic and loads that all packets use. Included once for each
// instruction set.
#if defined(RELJEF_PACKET_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELJEF_PACKET_LANES_INL_H
#undef RELJEF_PACKET_LANES_INL_H
#else
#define RELJEF_PACKET_LANES_INL_H
#endif

#include <array>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace reljef::cast::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::CappedTag<float, 16>;
using IntTag = hn::RebindToSigned<FloatTag>;
using Floats = hn::Vec<FloatTag>;
using Ints = hn::Vec<IntTag>;
using Lanes = hn::Mask<FloatTag>;
using IntLanes = hn::Mask<IntTag>;
constexpr FloatTag floats{};
constexpr IntTag ints{};

constexpr int lane_count = static_cast<int>(hn::MaxLanes(floats));

HWY_INLINE Floats all(float value) {
    return hn::Set(floats, value);
}

HWY_INLINE Ints all(std::int32_t value) {
    return hn::Set(ints, value);
}

HWY_INLINE Lanes no_lanes() {
    return hn::MaskFromVec(hn::Zero(floats));
}

// Towards zero, and to the nearest. The values must be in the range of ints: others give any.
#if HWY_TARGET <= HWY_AVX3
HWY_INLINE Ints truncated(Floats value) {
    return Ints{_mm512_cvttps_epi32(value.raw)};
}
HWY_INLINE Ints rounded(Floats value) {
    return Ints{_mm512_cvtps_epi32(value.raw)};
}
#elif HWY_TARGET == HWY_AVX2
HWY_INLINE Ints truncated(Floats value) {
    return Ints{_mm256_cvttps_epi32(value.raw)};
}
HWY_INLINE Ints rounded(Floats value) {
    return Ints{_mm256_cvtps_epi32(value.raw)};
}
#else
HWY_INLINE Ints truncated(Floats value) {
    return hn::ConvertTo(ints, value);
}
HWY_INLINE Ints rounded(Floats value) {
    return hn::NearestInt(value);
}
#endif

// Exactly `a` at part 0 and `b` at part 1.
HWY_INLINE Floats mixed(Floats a, Floats b, Floats part) {
    return hn::MulAdd(part, b, hn::NegMulAdd(part, a, a));
}

// 2^level.
HWY_INLINE Floats size_of(Ints level) {
    constexpr int exponent_bits = 23;
    constexpr int exponent_of_one = 127;
    return hn::BitCast(floats, hn::ShiftLeft<exponent_bits>(hn::Add(level, all(exponent_of_one))));
}

// The lanes of `lanes` in which a > b.
HWY_INLINE Lanes and_greater(Lanes lanes, Floats a, Floats b) {
#if HWY_TARGET <= HWY_AVX3
    return Lanes{_mm512_mask_cmp_ps_mask(lanes.raw, a.raw, b.raw, _CMP_GT_OQ)};
#else
    return hn::And(lanes, hn::Gt(a, b));
#endif
}

// Values that lie side by side.
template <class Vector> struct Neighbours {
    Vector first;
    Vector second;
};

#if HWY_TARGET != HWY_SCALAR
// A pair of values for each index.
template <class Tag, class U>
HWY_INLINE hn::Vec<Tag> load_pairs(Tag tag, const U* from, const std::int32_t* index) {
    if constexpr (hn::MaxLanes(tag) == 2) {
        return hn::LoadU(tag, from + *index);
    } else {
        const hn::Half<Tag> half;
        constexpr std::size_t pairs = hn::MaxLanes(half) / 2;
        return hn::Combine(tag, load_pairs(half, from, index + pairs),
                           load_pairs(half, from, index));
    }
}
#endif

// from[index] of `lanes`, anything in others. All indices must be valid.
#if HWY_TARGET <= HWY_AVX3
// g++ gathers into the register of the gather before, and waits for it, unless lanes are masked.
HWY_INLINE Floats gather(const float* from, Ints index, Lanes lanes) {
    return Floats{
        _mm512_mask_i32gather_ps(_mm512_setzero_ps(), lanes.raw, index.raw, from, sizeof(float))};
}

template <class Tag, class U>
HWY_INLINE hn::Vec<Tag> gather_pairs(Tag tag, const U* from, __m256i index) {
    constexpr hn::Repartition<double, Tag> pairs;
    constexpr __mmask8 all_pairs = 0xFF;
    const hn::Vec<decltype(pairs)> gathered{
        _mm512_mask_i32gather_pd(_mm512_setzero_pd(), all_pairs, index, from, sizeof(U))};
    return hn::BitCast(tag, gathered);
}
#else
HWY_INLINE Floats gather(const float* from, Ints index, Lanes /*lanes*/) {
    return hn::GatherIndex(floats, from, index);
}
#endif

// from[index] and from[index + 1]. Loads of eight bytes, one for each lane, are faster than two
// gathers of four bytes. On Intel's processors with AVX-512, gathers of eight bytes are faster
// still; on AMD's they are slower.
template <class Tag, class U>
HWY_INLINE Neighbours<hn::Vec<Tag>> load_neighbours(Tag tag, const U* from, Ints index) {
#if HWY_TARGET == HWY_SCALAR
    return {hn::GatherIndex(tag, from, index), hn::GatherIndex(tag, from + 1, index)};
#else
#if HWY_TARGET <= HWY_AVX3
    if (__builtin_cpu_is("intel") != 0) {
        const auto low = gather_pairs(tag, from, _mm512_castsi512_si256(index.raw));
        const auto high = gather_pairs(tag, from, _mm512_extracti64x4_epi64(index.raw, 1));
        return {hn::ConcatEven(tag, high, low), hn::ConcatOdd(tag, high, low)};
    }
#endif
    alignas(64) std::int32_t places[static_cast<std::size_t>(lane_count)];
    hn::Store(index, ints, places);
    const auto low = load_pairs(tag, from, places);
    const auto high = load_pairs(tag, from, places + lane_count / 2);
    return {hn::ConcatEven(tag, high, low), hn::ConcatOdd(tag, high, low)};
#endif
}

} // namespace reljef::cast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
