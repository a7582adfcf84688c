// Fine structure of the ground that a packet of rays hits. Included once for each instruction set.
#if defined(RELJEF_PACKET_GRAIN_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELJEF_PACKET_GRAIN_INL_H
#undef RELJEF_PACKET_GRAIN_INL_H
#else
#define RELJEF_PACKET_GRAIN_INL_H
#endif

#include <array>
#include <bit>

#include "engine/cast/packet/packet_light-inl.h"

HWY_BEFORE_NAMESPACE();
namespace reljef::cast::HWY_NAMESPACE {

#include "shaders/terrain/overlay_numbers.inc"

// Where hits are from the eye, and their rays.
struct GroundPlace {
    std::array<Floats, 3> from_eye; // metres
    std::array<Floats, 3> view;     // direction of the ray
    Floats distance;                // metres
    Floats view_length;
};

// Along the axes of the patterns.
HWY_INLINE std::array<Floats, 3> turned(glm::vec2 turn, const std::array<Floats, 3>& world) {
    const Floats cosine = all(turn.x);
    const Floats sine = all(turn.y);
    return {hn::MulAdd(cosine, world[0], hn::Mul(sine, world[1])),
            hn::MulSub(cosine, world[1], hn::Mul(sine, world[0])), world[2]};
}

// The normal of the hits' surface along the axes of the patterns, unit vectors.
HWY_INLINE std::array<Floats, 3> grain_normal(const TilePaint& paint, const PacketHits& hits) {
    const Slopes slopes = slopes_of(hits);
    const glm::mat3& from = paint.normal_from_slopes;
    std::array<Floats, 3> normal;
    Floats square = hn::Zero(floats);
    for (int axis = 0; axis < 3; ++axis) {
        const auto index = static_cast<std::size_t>(axis);
        normal[index] =
            hn::NegMulAdd(slopes.col, all(from[0][axis]),
                          hn::NegMulAdd(slopes.row, all(from[1][axis]), all(from[2][axis])));
        square = hn::MulAdd(normal[index], normal[index], square);
    }
    const Floats per_length = hn::Div(all(1.0F), hn::Sqrt(square));
    for (Floats& component : normal) {
        component = hn::Mul(component, per_length);
    }
    return normal;
}

HWY_INLINE Floats dot(const std::array<Floats, 3>& a, const std::array<Floats, 3>& b) {
    return hn::MulAdd(a[0], b[0], hn::MulAdd(a[1], b[1], hn::Mul(a[2], b[2])));
}

HWY_INLINE std::array<Floats, 3> all_of(glm::vec3 vector) {
    return {all(vector.x), all(vector.y), all(vector.z)};
}

// Hermite's step from 0 to 1 over `width` from `begin` on.
HWY_INLINE Floats smooth_rise(float begin, float width, Floats x) {
    const Floats part = hn::Min(
        hn::Max(hn::Mul(hn::Sub(x, all(begin)), all(1.0F / width)), hn::Zero(floats)), all(1.0F));
    return hn::Mul(hn::Mul(part, part), hn::NegMulAdd(all(2.0F), part, all(3.0F)));
}

// As smoothstep() of GLSL; `begin` may be the larger one.
HWY_INLINE Floats smooth_step(float begin, float end, Floats x) {
    return smooth_rise(begin, end - begin, x);
}

// Slopes along u and v, and change of the brightness.
struct Grain {
    Floats u;
    Floats v;
    Floats brightness;

    HWY_INLINE static Grain nothing() {
        return {hn::Zero(floats), hn::Zero(floats), hn::Zero(floats)};
    }
};

// The bits of texels. add_layer() turns their sum into slopes and brightness.
HWY_INLINE void add_grain(Ints texel, Floats weight, Grain& sum) {
    const auto [u, v, brightness] = channels_of(texel);
    sum.u = hn::MulAdd(u, weight, sum.u);
    sum.v = hn::MulAdd(v, weight, sum.v);
    sum.brightness = hn::MulAdd(brightness, weight, sum.brightness);
}

// A place in a pattern, in widths.
struct PatternPlace {
    Floats u;
    Floats v;
};

// Bilinear, of a level of each lane.
HWY_INLINE void add_grain_level(const GrainPaint& grain, int layer, const PatternPlace& place,
                                Ints level, Floats weight, Grain& sum) {
    const Ints last = hn::Sub(hn::Shr(all(grain.side), level), all(std::int32_t{1}));
    const Floats width = hn::ConvertTo(floats, hn::Shr(all(grain.side), level));
    const Floats u = hn::MulSub(place.u, width, all(0.5F));
    const Floats v = hn::MulSub(place.v, width, all(0.5F));
    const Floats floor_u = hn::Floor(u);
    const Floats floor_v = hn::Floor(v);
    const Floats part_u = hn::Sub(u, floor_u);
    const Floats part_v = hn::Sub(v, floor_v);
    const Ints one = all(std::int32_t{1});
    const Ints col = hn::And(hn::ConvertTo(ints, floor_u), last);
    const Ints row = hn::And(hn::ConvertTo(ints, floor_v), last);
    const Ints next_col = hn::And(hn::Add(col, one), last);
    const Ints next_row = hn::And(hn::Add(row, one), last);
    const Ints shift = hn::Sub(all(std::countr_zero(static_cast<unsigned>(grain.side))), level);
    const Ints begin = hn::GatherIndex(ints, grain.begin.data(), level);
    const Ints here = hn::Add(begin, hn::Shl(row, shift));
    const Ints below = hn::Add(begin, hn::Shl(next_row, shift));
    const auto* const first =
        reinterpret_cast<const std::int32_t*>(grain.texels) + layer * grain.layer_texels;
    const Floats right = hn::Mul(weight, part_u);
    const Floats left = hn::Sub(weight, right);
    const Floats right_below = hn::Mul(right, part_v);
    const Floats left_below = hn::Mul(left, part_v);
    const auto at = [&](Ints row_begin, Ints texel_col) HWY_ATTR {
        return hn::GatherIndex(ints, first, hn::Add(row_begin, texel_col));
    };
    add_grain(at(here, col), hn::Sub(left, left_below), sum);
    add_grain(at(here, next_col), hn::Sub(right, right_below), sum);
    add_grain(at(below, col), left_below, sum);
    add_grain(at(below, next_col), right_below, sum);
}

// A layer of a pattern: bilinear in the two levels nearest to each lane's.
HWY_INLINE void add_layer(const GrainPaint& grain, int layer, const PatternPlace& place,
                          Floats level, Floats weight, Grain& sum) {
    const Ints fine = hn::ConvertTo(ints, level);
    const Floats coarse_part = hn::Sub(level, hn::ConvertTo(floats, fine));
    const Floats coarse = hn::Mul(weight, coarse_part);
    Grain bits = Grain::nothing();
    add_grain_level(grain, layer, place, fine, hn::Sub(weight, coarse), bits);
    if (!hn::AllTrue(floats, hn::Eq(coarse, hn::Zero(floats)))) {
        const Ints next = hn::Min(hn::Add(fine, all(std::int32_t{1})), all(grain.level_count - 1));
        add_grain_level(grain, layer, place, next, coarse, bits);
    }
    const auto add = [&](Floats part, Floats& channel) HWY_ATTR {
        channel = hn::Add(channel, hn::MulSub(part, all(2.0F / 1023.0F), weight));
    };
    add(bits.u, sum.u);
    add(bits.v, sum.v);
    add(bits.brightness, sum.brightness);
}

// A sine of amplitude 1 and period 1, but of parabolas.
HWY_INLINE Floats wave(Floats x) {
    const Floats part = hn::Sub(x, hn::Round(x));
    return hn::Mul(hn::Mul(all(8.0F), part), hn::NegMulAdd(all(2.0F), hn::Abs(part), all(1.0F)));
}

// The widest pattern, bent: view::GrainView::copies.
HWY_INLINE PatternPlace bent(const PatternPlace& place) {
    const auto bend = [](Floats across) HWY_ATTR {
        const Floats slow = wave(hn::MulAdd(across, all(1.0F / 11.0F), all(0.3F)));
        return hn::Mul(all(bend_height), hn::Add(wave(hn::Mul(across, all(1.0F / 7.0F))), slow));
    };
    return {hn::Add(place.u, bend(place.v)), hn::Add(place.v, bend(place.u))};
}

// A plane between two axes, and its share.
struct PatternPlane {
    int u = 0;
    int v = 1;
    Floats share;

    HWY_INLINE PatternPlace of(const std::array<Floats, 3>& vector) const {
        return {vector[static_cast<std::size_t>(u)], vector[static_cast<std::size_t>(v)]};
    }
};

// Level ground lies in the plane xy, steep ground in the upright plane that it faces.
HWY_INLINE std::array<PatternPlane, 3> pattern_planes(const std::array<Floats, 3>& normal) {
    const Floats level = smooth_step(upright_end, upright_begin, hn::Abs(normal[2]));
    const Floats turn = hn::Sub(hn::Abs(normal[0]), hn::Abs(normal[1]));
    const Floats upright = hn::Sub(all(1.0F), level);
    const Floats along_y = hn::Mul(upright, smooth_step(-upright_turn, upright_turn, turn));
    return {{{0, 2, hn::Sub(upright, along_y)}, {1, 2, along_y}, {0, 1, level}}};
}

// Changes of the cosine of the angle to the sun, and of the brightness.
struct GrainLook {
    Floats to_sun;
    Floats brightness;
};

// A pattern in a plane. `seen`: its share.
HWY_INLINE void add_pattern(const GrainPaint& grain, const PatternPlane& plane,
                            const PatternPlace& place, Floats level, Floats rock, Floats seen,
                            GrainLook& sum) {
    const Floats zero = hn::Zero(floats);
    Grain slopes = Grain::nothing();
    const std::array<Floats, 2> shares{hn::NegMulAdd(seen, rock, seen), hn::Mul(seen, rock)};
    for (int layer = 0; layer < 2; ++layer) {
        const Floats share = shares[static_cast<std::size_t>(layer)];
        if (!hn::AllTrue(floats, hn::Le(share, zero))) {
            add_layer(grain, layer, place, level, share, slopes);
        }
    }
    const PatternPlace sun = plane.of(all_of(grain.to_sun));
    sum.to_sun = hn::NegMulAdd(slopes.u, sun.u, hn::NegMulAdd(slopes.v, sun.v, sum.to_sun));
    sum.brightness = hn::Add(sum.brightness, slopes.brightness);
}

// The sum of the visible patterns.
HWY_INLINE GrainLook grain_at(const GrainPaint& grain, const GroundPlace& place,
                              const std::array<Floats, 3>& normal, Lanes found) {
    const Floats zero = hn::Zero(floats);
    const Floats facing =
        hn::Div(hn::Abs(dot(normal, turned(grain.turn, place.view))), place.view_length);
    const Floats longer = hn::Sqrt(hn::Div(all(1.0F), hn::Max(facing, all(flattest_facing))));
    const Floats width =
        hn::MulAdd(place.distance, all(grain.metres_a_pixel.y), all(grain.metres_a_pixel.x));
    const Floats pixel = hn::Mul(width, hn::Mul(longer, hn::Sqrt(longer))); // and its length
    const Floats rock = smooth_step(rock_begin, rock_end, dot(normal, all_of(grain.up)));
    const std::array<PatternPlane, 3> planes = pattern_planes(normal);
    const std::array<Floats, 3> from_eye = turned(grain.turn, place.from_eye);
    GrainLook sum{zero, zero};
    for (int i = 0; i < grain.pattern_count; ++i) {
        const glm::vec4 pattern = grain.patterns[static_cast<std::size_t>(i)];
        const Floats texels = hn::Mul(pixel, all(pattern.w * static_cast<float>(grain.side)));
        const Floats fine = hn::Max(log2_of(texels), zero);
        const Floats level = hn::Min(fine, all(last_seen_level + 1.0F));
        const Floats seen = hn::Min(hn::Sub(all(last_seen_level + 1.0F), level), all(1.0F));
        const std::array<Floats, 3> at{hn::MulAdd(from_eye[0], all(pattern.w), all(pattern.x)),
                                       hn::MulAdd(from_eye[1], all(pattern.w), all(pattern.y)),
                                       hn::MulAdd(from_eye[2], all(pattern.w), all(pattern.z))};
        for (const PatternPlane& plane : planes) {
            const Floats share = hn::IfThenElseZero(found, hn::Mul(seen, plane.share));
            if (!hn::AllTrue(floats, hn::Le(share, zero))) {
                const PatternPlace on = plane.of(at);
                add_pattern(grain, plane, i == 0 ? bent(on) : on, level, rock, share, sum);
            }
        }
    }
    return sum;
}

// The strength of grain. Snow, the brightest ground, is smoother, and level water has none.
HWY_INLINE Floats strength_on(const GrainPaint& grain, const std::array<Floats, 3>& normal,
                              const Color& lit) {
    const Floats luminance = hn::MulAdd(
        lit.r, all(0.2126F), hn::MulAdd(lit.g, all(0.7152F), hn::Mul(lit.b, all(0.0722F))));
    const Floats rough = hn::NegMulAdd(all(snow_smoothness),
                                       smooth_step(snow_begin, snow_end, luminance), all(1.0F));
    const Lanes is_level = hn::Gt(dot(normal, all_of(grain.up)), all(level_cosine));
    const Lanes is_water = hn::And(is_level, hn::Gt(lit.b, hn::Mul(all(blue_of_water), lit.r)));
    return hn::IfThenZeroElse(is_water, hn::Mul(all(grain.strength), rough));
}

// The colour of ground with its grain: slopes change the share of the sun's light, and the
// brightness changes all light. Ground that the sun hardly reaches is as grainy as if it did: else
// the steps of normals from cell to cell would show.
HWY_INLINE Color with_grain(const BlockPaint& paint, const TilePaint& tile,
                            const GroundPlace& place, const PacketHits& hits, const Color& lit) {
    const Floats zero = hn::Zero(floats);
    const GrainPaint& grain = *paint.grain;
    const std::array<Floats, 3> normal = grain_normal(tile, hits);
    const GrainLook look = grain_at(grain, place, normal, hits.found);
    const Floats strength = strength_on(grain, normal, lit);
    const Floats to_sun = hn::Max(dot(normal, all_of(grain.to_sun)), all(grain_grazing));
    const Floats grainy =
        hn::MulAdd(look.to_sun, hn::Mul(strength, all(grain_slope_scale)), to_sun);
    const Floats light = hn::Div(hn::Add(hn::Max(grainy, zero), all(grain_sky_share)),
                                 hn::Add(to_sun, all(grain_sky_share)));
    const Floats brightness =
        hn::MulAdd(look.brightness, hn::Mul(strength, all(grain_brightness_scale)), all(1.0F));
    return scaled(lit, hn::Mul(light, hn::Max(brightness, zero)));
}

} // namespace reljef::cast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
