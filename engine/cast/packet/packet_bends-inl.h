// Bent rays to the sun, over the ellipsoid. Included once for each instruction set.
#if defined(RELJEF_PACKET_BENDS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELJEF_PACKET_BENDS_INL_H
#undef RELJEF_PACKET_BENDS_INL_H
#else
#define RELJEF_PACKET_BENDS_INL_H
#endif

#include <array>
#include <cstddef>
#include <type_traits>

#include "engine/cast/packet/packet_walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace reljef::cast::HWY_NAMESPACE {

// Along the surface's columns and rows, samples, and upwards, true metres.
using SunWay = std::array<Floats, 3>;

// What is needed of the rays of a packet.
struct BentRays {
    Floats x; // unit place
    Floats y;
    Floats zero; // height of the geoid
    std::array<SunWay, 4> factors;
};

// A polynomial in the unit place.
template <int side>
HWY_INLINE Floats factor_of(const glm::vec3* terms, int axis, Floats x, Floats y) {
    Floats sum = hn::Zero(floats);
    for (int j = side - 1; j >= 0; --j) {
        Floats line = all(terms[j * side + side - 1][axis]);
        for (int i = side - 2; i >= 0; --i) {
            line = hn::MulAdd(line, x, all(terms[j * side + i][axis]));
        }
        sum = hn::MulAdd(sum, y, line);
    }
    return sum;
}

// Height of the geoid at unit places, bilinear; beside the map as at its border.
HWY_INLINE Floats zero_at(const SunBends& bends, Floats x, Floats y) {
    const auto place = [&](Floats unit, int axis) HWY_ATTR {
        const Floats on =
            hn::MulAdd(unit, all(bends.zero_scale[axis]), all(bends.zero_first[axis]));
        const auto last = static_cast<float>(bends.zero_count[axis] - 1);
        return hn::Min(hn::Max(on, hn::Zero(floats)), all(last));
    };
    const auto cell = [&](Floats on, int axis) HWY_ATTR {
        return hn::Min(truncated(on), all(bends.zero_count[axis] - 2));
    };
    const Floats u = place(x, 0);
    const Floats v = place(y, 1);
    const Ints col = cell(u, 0);
    const Ints row = cell(v, 1);
    const Ints index = hn::Add(hn::Mul(row, all(bends.zero_count.x)), col);
    const auto north = load_neighbours(floats, bends.zeros, index);
    const auto south = load_neighbours(floats, bends.zeros + bends.zero_count.x, index);
    const Floats part = hn::Sub(u, hn::ConvertTo(floats, col));
    return mixed(mixed(north.first, north.second, part), mixed(south.first, south.second, part),
                 hn::Sub(v, hn::ConvertTo(floats, row)));
}

HWY_INLINE BentRays bent_rays(const BlockJob& job, const PacketHits& hits) {
    const SunBends& bends = *job.bends;
    const auto unit = [&](Ints cell, Floats part, int axis) HWY_ATTR {
        return hn::MulAdd(hn::Add(hn::ConvertTo(floats, cell), part), all(job.unit_scale[axis]),
                          all(job.unit_first[axis]));
    };
    BentRays rays;
    rays.x = unit(hits.col, hits.col_part, 0);
    rays.y = unit(hits.row, hits.row_part, 1);
    rays.zero = bends.zeros != nullptr ? zero_at(bends, rays.x, rays.y) : hn::Zero(floats);
    const Floats height = hn::Add(hn::Add(hits.height, all(job.rays.base_height)), rays.zero);
    const Floats z = hn::MulAdd(height, all(bends.unit_per_metre), all(bends.unit_height));
    const glm::vec3* const terms = bends.terms.data();
    for (int axis = 0; axis < 3; ++axis) {
        const auto at = static_cast<std::size_t>(axis);
        const auto factor = [&](auto side, int first) HWY_ATTR {
            return factor_of<side>(terms + first, axis, rays.x, rays.y);
        };
        using std::integral_constant;
        rays.factors[0][at] = hn::MulAdd(factor(integral_constant<int, 5>(), 25), z,
                                         factor(integral_constant<int, 5>(), 0));
        rays.factors[1][at] =
            hn::MulAdd(all(terms[66][axis]), z, factor(integral_constant<int, 4>(), 50));
        rays.factors[2][at] = factor(integral_constant<int, 3>(), 67);
        rays.factors[3][at] = factor(integral_constant<int, 2>(), 76);
    }
    return rays;
}

// From the hits to a part of their rays.
HWY_INLINE SunWay way_to(const SunBends& bends, const BentRays& rays, float part) {
    SunWay way;
    for (std::size_t axis = 0; axis < way.size(); ++axis) {
        const auto factor = [&](std::size_t power) HWY_ATTR { return rays.factors[power][axis]; };
        const Floats by = all(part);
        const Floats mean = hn::MulAdd(
            hn::MulAdd(hn::MulAdd(factor(3), by, factor(2)), by, factor(1)), by, factor(0));
        way[axis] = hn::Mul(mean, by);
    }
    if (bends.zeros != nullptr && part > 0.0F) {
        const Floats x = hn::MulAdd(way[0], all(bends.unit_per_sample.x), rays.x);
        const Floats y = hn::MulAdd(way[1], all(bends.unit_per_sample.y), rays.y);
        way[2] = hn::Sub(way[2], hn::Sub(zero_at(bends, x, y), rays.zero));
    }
    return way;
}

} // namespace reljef::cast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
