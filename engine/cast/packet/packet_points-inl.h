// The light of point lights on the ground that a packet of rays hits, as
// shaders/material/point_lights.glsl. Included once for each instruction set.
#if defined(RELJEF_PACKET_POINTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELJEF_PACKET_POINTS_INL_H
#undef RELJEF_PACKET_POINTS_INL_H
#else
#define RELJEF_PACKET_POINTS_INL_H
#endif

#include "engine/cast/packet/packet_grain-inl.h"

HWY_BEFORE_NAMESPACE();
namespace reljef::cast::HWY_NAMESPACE {

using Vectors = std::array<Floats, 3>;

HWY_INLINE Color added(const Color& a, const Color& b) {
    return {hn::Add(a.r, b.r), hn::Add(a.g, b.g), hn::Add(a.b, b.b)};
}

HWY_INLINE Color product(const Color& a, const Color& b) {
    return {hn::Mul(a.r, b.r), hn::Mul(a.g, b.g), hn::Mul(a.b, b.b)};
}

// Adds the light at albedo 1. `place`: from the eye, world metres; `normal`: unit vectors.
HWY_INLINE void add_point(const PointLightPaint& light, const Vectors& place, const Vectors& normal,
                          Color& sum) {
    const Vectors way{hn::Sub(all(light.from_eye.x), place[0]),
                      hn::Sub(all(light.from_eye.y), place[1]),
                      hn::Sub(all(light.from_eye.z), place[2])};
    const Floats square = hn::Max(dot(way, way), all(light.nearest_square));
    const Floats part = hn::Mul(square, all(light.per_squared_range));
    const Floats window = hn::Max(hn::NegMulAdd(part, part, all(1.0F)), hn::Zero(floats));
    const Floats facing = hn::Max(dot(normal, way), hn::Zero(floats));
    const Floats lit = hn::Mul(facing, hn::Mul(window, window));
    if (hn::AllTrue(floats, hn::Eq(lit, hn::Zero(floats)))) {
        return;
    }
    const Floats share = hn::Div(lit, hn::Mul(square, hn::Sqrt(square)));
    sum.r = hn::MulAdd(all(light.color.r), share, sum.r);
    sum.g = hn::MulAdd(all(light.color.g), share, sum.g);
    sum.b = hn::MulAdd(all(light.color.b), share, sum.b);
}

HWY_NOINLINE Color light_of_points(const BlockPaint& paint, const Vectors& place,
                                   const Vectors& normal) {
    Color sum = all(glm::vec3(0.0F));
    for (const PointLightPaint& light : paint.point_lights) {
        add_point(light, place, normal, sum);
    }
    return sum;
}

HWY_INLINE Vectors turned_by(const glm::mat3& turn, const Vectors& vector) {
    Vectors turned;
    for (int axis = 0; axis < 3; ++axis) {
        turned[static_cast<std::size_t>(axis)] = hn::MulAdd(
            vector[0], all(turn[0][axis]),
            hn::MulAdd(vector[1], all(turn[1][axis]), hn::Mul(vector[2], all(turn[2][axis]))));
    }
    return turned;
}

// Of a map of packed_normal(), along the local axes, of any length.
HWY_INLINE Vectors map_normal(const TilePaint& normals, const PacketHits& hits, Floats level) {
    const Color sum = map_sum<Linear>(normals, hits, level);
    const auto component = [](Floats value) HWY_ATTR {
        return hn::Sub(value, all(static_cast<float>(normal_zero)));
    };
    return {component(sum.r), component(sum.g), component(sum.b)};
}

// What ground reflects of point lights. Precondition: they reach the job's tile.
HWY_NOINLINE Color reflected_from_points(const BlockJob& job, const BlockPaint& paint,
                                         const Vectors& place, const PacketHits& hits,
                                         Floats level) {
    const Vectors local = map_normal(*job.normals, hits, level);
    const Vectors normal = unit_vector(turned_by(paint.world_from_normal, local));
    const Color light = light_of_points(paint, place, normal);
    return product(map_color(*job.albedo, hits, level), light);
}

} // namespace reljef::cast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
