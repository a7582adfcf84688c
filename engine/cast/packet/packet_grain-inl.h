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

// A normal of the hits' surface along the axes of the patterns, of any length.
HWY_INLINE std::array<Floats, 3> normal_of(const TilePaint& paint, const PacketHits& hits) {
    const Slopes slopes = slopes_of(hits);
    const glm::mat3& from = paint.normal_from_slopes;
    const auto component = [&](int axis) HWY_ATTR {
        return hn::NegMulAdd(slopes.col, all(from[0][axis]),
                             hn::NegMulAdd(slopes.row, all(from[1][axis]), all(from[2][axis])));
    };
    return {component(0), component(1), component(2)};
}

HWY_INLINE Floats dot(const std::array<Floats, 3>& a, const std::array<Floats, 3>& b) {
    return hn::MulAdd(a[0], b[0], hn::MulAdd(a[1], b[1], hn::Mul(a[2], b[2])));
}

HWY_INLINE std::array<Floats, 3> unit_vector(const std::array<Floats, 3>& vector) {
    const Floats tiny = all(1e-30F); // of lanes without hits
    const Floats per_length = hn::Div(all(1.0F), hn::Sqrt(hn::Max(dot(vector, vector), tiny)));
    return {hn::Mul(vector[0], per_length), hn::Mul(vector[1], per_length),
            hn::Mul(vector[2], per_length)};
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
};

// The bits of texels. grain_in() turns their sum into slopes and brightness.
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

// Bilinear, of the layer and level of each lane.
HWY_INLINE Grain grain_in(const GrainPaint& grain, Ints layer, const PatternPlace& place,
                          Ints level) {
    const Ints last = hn::Sub(hn::Shr(all(grain.side), level), all(std::int32_t{1}));
    const Floats width = hn::ConvertTo(floats, hn::Shr(all(grain.side), level));
    const Floats u = hn::MulSub(place.u, width, all(0.5F));
    const Floats v = hn::MulSub(place.v, width, all(0.5F));
    const Floats floor_u = hn::Floor(u);
    const Floats floor_v = hn::Floor(v);
    const Floats part_u = hn::Sub(u, floor_u);
    const Floats part_v = hn::Sub(v, floor_v);
    const Ints one = all(std::int32_t{1});
    const Ints col = hn::And(truncated(floor_u), last);
    const Ints row = hn::And(truncated(floor_v), last);
    const Ints next_col = hn::And(hn::Add(col, one), last);
    const Ints next_row = hn::And(hn::Add(row, one), last);
    const Ints shift = hn::Sub(all(std::countr_zero(static_cast<unsigned>(grain.side))), level);
    const Ints begin = hn::Add(hn::Mul(layer, all(grain.layer_texels)),
                               hn::GatherIndex(ints, grain.begin.data(), level));
    const Ints here = hn::Add(begin, hn::Shl(row, shift));
    const Ints below = hn::Add(begin, hn::Shl(next_row, shift));
    const auto* const first = reinterpret_cast<const std::int32_t*>(grain.texels);
    const Floats right = part_u;
    const Floats left = hn::Sub(all(1.0F), part_u);
    const Floats right_below = hn::Mul(right, part_v);
    const Floats left_below = hn::Mul(left, part_v);
    Grain sum{hn::Zero(floats), hn::Zero(floats), hn::Zero(floats)};
    const auto at = [&](Ints row_begin, Ints texel_col) HWY_ATTR {
        return hn::GatherIndex(ints, first, hn::Add(row_begin, texel_col));
    };
    add_grain(at(here, col), hn::Sub(left, left_below), sum);
    add_grain(at(here, next_col), hn::Sub(right, right_below), sum);
    add_grain(at(below, col), left_below, sum);
    add_grain(at(below, next_col), right_below, sum);
    const auto shown = [](Floats bits)
                           HWY_ATTR { return hn::MulSub(bits, all(2.0F / 1023.0F), all(1.0F)); };
    return {shown(sum.u), shown(sum.v), shown(sum.brightness)};
}

// Between the two levels nearest to each lane's, but near a level that level alone: most packets
// fetch no second one.
HWY_INLINE Grain grain_between(const GrainPaint& grain, Ints layer, const PatternPlace& place,
                               Floats level) {
    const Floats zero = hn::Zero(floats);
    const Ints fine = truncated(level);
    const Floats off = hn::Sub(hn::Sub(level, hn::ConvertTo(floats, fine)), all(0.5F));
    const Floats steep = hn::MulAdd(off, all(level_steepness), all(0.5F));
    const Floats part = hn::Min(hn::Max(steep, zero), all(1.0F));
    const Grain near = grain_in(grain, layer, place, fine);
    if (hn::AllTrue(floats, hn::Eq(part, zero))) {
        return near;
    }
    const Ints next = hn::Min(hn::Add(fine, all(std::int32_t{1})), all(grain.level_count - 1));
    const Grain coarse = grain_in(grain, layer, place, next);
    const auto mix = [&](Floats from, Floats to)
                         HWY_ATTR { return hn::MulAdd(part, hn::Sub(to, from), from); };
    return {mix(near.u, coarse.u), mix(near.v, coarse.v), mix(near.brightness, coarse.brightness)};
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

// Noise that the mip levels follow, and the choices of the widest pattern; those of the others
// follow the pattern before.
HWY_INLINE Grain widest_noise(const std::array<Floats, 3>& at) {
    const auto wave_along = [&](float x, float y, float z) HWY_ATTR {
        return wave(dot(at, {all(x / 77.0F), all(y / 77.0F), all(z / 77.0F)}));
    };
    const Floats first = wave_along(99.0F, 42.0F, 110.0F);
    const Floats second = wave_along(-66.0F, 98.0F, 56.0F);
    const Floats third = wave_along(35.0F, -99.0F, 84.0F);
    const auto noise = [](Floats a, Floats b)
                           HWY_ATTR { return hn::Mul(all(choice_noise), hn::Add(a, b)); };
    return {noise(first, second), noise(second, third), noise(third, first)};
}

// One of two looks, which a pattern shows, and its strength beside the line between them. The line
// wanders with the noise.
struct Choice {
    Lanes is_first;
    Floats strength;
};

HWY_INLINE Choice choice(Floats share, Floats noise) {
    const Floats wander = hn::Min(hn::Max(noise, all(-widest_wander)), all(widest_wander));
    const Floats off = hn::Sub(hn::Sub(share, all(0.5F)), wander);
    return {hn::Gt(off, hn::Zero(floats)),
            hn::Min(hn::Mul(hn::Abs(off), all(1.0F / choice_border)), all(1.0F))};
}

// Shares of the first look of each choice.
struct ShareOfChoices {
    Floats scree; // the kinds of ground; without them it is soil
    Floats grass;
    Floats rock;
    Floats snow;
    Floats flat; // the level plane
    Floats by_y; // of upright planes, yz
};

// Colours count as on level ground. Excess green: Woebbecke et al. 1995.
HWY_INLINE ShareOfChoices shares_of_choices(const GrainPaint& grain,
                                            const std::array<Floats, 3>& normal, const Color& lit) {
    const Floats cosine = dot(normal, all_of(grain.up));
    const glm::vec3 light = 1.0F / grain.level_light;
    const Floats red = hn::MulAdd(lit.r, all(light.r), all(dark_red));
    const Floats green = hn::MulAdd(lit.g, all(light.g), all(dark_green));
    const Floats blue = hn::Mul(lit.b, all(light.b));
    const Floats sum = hn::Add(hn::Add(red, green), blue);
    const Floats greyness = hn::Div(hn::Sub(blue, red), sum);
    const Floats excess_green = hn::Sub(hn::Div(hn::Mul(all(3.0F), green), sum), all(1.0F));
    const Floats whiteness = hn::Div(hn::Mul(all(3.0F), hn::Mul(blue, blue)), sum);
    const Floats turn = hn::Sub(hn::Abs(normal[0]), hn::Abs(normal[1]));
    return {smooth_step(scree_begin, scree_end, greyness),
            smooth_step(grass_begin, grass_end, excess_green),
            smooth_step(rock_begin, rock_end, cosine),
            smooth_step(snow_begin, snow_end, whiteness),
            smooth_step(upright_end, upright_begin, hn::Abs(normal[2])),
            smooth_step(-upright_turn, upright_turn, turn)};
}

// The last kind that is chosen.
HWY_INLINE Ints layer_of(const ShareOfChoices& shares, const Grain& noise) {
    Ints last = hn::Zero(ints);
    const auto choose = [&](float layer, Floats share, Floats wander) HWY_ATTR {
        const Lanes is_chosen = choice(share, wander).is_first;
        last = hn::IfThenElse(hn::RebindMask(ints, is_chosen),
                              all(static_cast<std::int32_t>(layer)), last);
    };
    choose(scree_layer, shares.scree, noise.u);
    choose(grass_layer, shares.grass, noise.v);
    choose(rock_layer, shares.rock, noise.brightness);
    choose(snow_layer, shares.snow, hn::Neg(noise.v));
    return last;
}

// Changes of the cosine of the angle to the sun, of the brightness, and of the grass's alone.
struct GrainLook {
    Floats to_sun;
    Floats brightness;
    Floats of_grass;
};

// Where a pattern is seen, in its widths, and as how large pixels.
struct PatternView {
    std::array<Floats, 3> at;
    Floats level; // of its mip levels
    Floats seen;  // its share
};

HWY_INLINE PatternView pattern_view(const glm::vec4& pattern, const std::array<Floats, 3>& from_eye,
                                    Floats texels) {
    const Floats fine = hn::Max(log2_of(hn::Mul(texels, all(pattern.w))), hn::Zero(floats));
    const Floats level = hn::Min(fine, all(last_seen_level + 1.0F));
    return {{hn::MulAdd(from_eye[0], all(pattern.w), all(pattern.x)),
             hn::MulAdd(from_eye[1], all(pattern.w), all(pattern.y)),
             hn::MulAdd(from_eye[2], all(pattern.w), all(pattern.z))},
            level,
            hn::Min(hn::Sub(all(last_seen_level + 1.0F), level), all(1.0F))};
}

// Adds a pattern: one layer in one plane. `noise`: what its choices follow; then what those of the
// next one do.
HWY_INLINE void add_pattern(const GrainPaint& grain, const PatternView& view,
                            const ShareOfChoices& shares, bool is_bent, Grain& noise,
                            GrainLook& sum) {
    const Ints layer = layer_of(shares, noise);
    const Choice flat = choice(shares.flat, noise.u);
    const Choice by_y = choice(shares.by_y, noise.v);
    const Lanes is_y = hn::AndNot(flat.is_first, by_y.is_first);
    const auto in_plane = [&](const std::array<Floats, 3>& vector) HWY_ATTR {
        return PatternPlace{hn::IfThenElse(is_y, vector[1], vector[0]),
                            hn::IfThenElse(flat.is_first, vector[1], vector[2])};
    };
    const PatternPlace place = in_plane(view.at);
    const PatternPlace sun = in_plane(all_of(grain.to_sun));
    noise = grain_between(grain, layer, is_bent ? bent(place) : place, view.level);
    const Floats of_plane = hn::IfThenElse(flat.is_first, all(1.0F), by_y.strength);
    const Floats strength = hn::Mul(view.seen, hn::Mul(flat.strength, of_plane));
    const Floats away = hn::MulAdd(noise.u, sun.u, hn::Mul(noise.v, sun.v));
    sum.to_sun = hn::NegMulAdd(strength, away, sum.to_sun);
    sum.brightness = hn::MulAdd(strength, noise.brightness, sum.brightness);
    const Lanes is_grass =
        hn::RebindMask(floats, hn::Eq(layer, all(static_cast<std::int32_t>(grass_layer))));
    sum.of_grass =
        hn::MulAdd(hn::IfThenElseZero(is_grass, strength), noise.brightness, sum.of_grass);
}

// The sum of the visible patterns.
HWY_INLINE GrainLook grain_at(const GrainPaint& grain, const GroundPlace& place,
                              const std::array<Floats, 3>& normal, const ShareOfChoices& shares,
                              Lanes found) {
    const Floats zero = hn::Zero(floats);
    const Floats facing =
        hn::Div(hn::Abs(dot(normal, turned(grain.turn, place.view))), place.view_length);
    const Floats longer = hn::Sqrt(hn::Div(all(1.0F), hn::Max(facing, all(flattest_facing))));
    const Floats width =
        hn::MulAdd(place.distance, all(grain.metres_a_pixel.y), all(grain.metres_a_pixel.x));
    const Floats pixel = hn::Mul(width, hn::Mul(longer, hn::Sqrt(longer))); // and its length
    const Floats texels = hn::Mul(pixel, all(static_cast<float>(grain.side)));
    const std::array<Floats, 3> from_eye = turned(grain.turn, place.from_eye);
    GrainLook sum{zero, zero, zero};
    Grain noise{zero, zero, zero};
    Floats wander = zero;
    for (int i = 0; i < grain.pattern_count; ++i) {
        PatternView view =
            pattern_view(grain.patterns[static_cast<std::size_t>(i)], from_eye, texels);
        view.seen = hn::IfThenElseZero(found, view.seen);
        if (hn::AllTrue(floats, hn::Le(view.seen, zero))) {
            return sum; // nor are narrower ones
        }
        if (i == 0) {
            noise = widest_noise(view.at);
            wander = noise.brightness;
        }
        view.level = hn::Max(hn::Add(view.level, wander), zero);
        add_pattern(grain, view, shares, i == 0, noise, sum);
    }
    return sum;
}

// The contrast of grain. Level water has none.
HWY_INLINE Floats strength_on(const GrainPaint& grain, const std::array<Floats, 3>& normal,
                              const Color& lit) {
    const Lanes is_level = hn::Gt(dot(normal, all_of(grain.up)), all(level_cosine));
    const Lanes is_water = hn::And(is_level, hn::Gt(lit.b, hn::Mul(all(blue_of_water), lit.r)));
    return hn::IfThenZeroElse(is_water, all(grain.strength));
}

// Ground with its grain: slopes change the share of the sun's light, and the brightness changes all
// light. Ground that the sun hardly reaches is as grainy as if it did: else the steps of normals
// from cell to cell would show.
// `by_sun`: the part of `lit` by the sun and the sky.
HWY_INLINE Color with_grain(const BlockPaint& paint, const TilePaint& tile,
                            const GroundPlace& place, const PacketHits& hits, const Color& by_sun,
                            const Color& lit) {
    const Floats zero = hn::Zero(floats);
    const GrainPaint& grain = *paint.grain;
    const std::array<Floats, 3> normal = unit_vector(normal_of(tile, hits));
    const ShareOfChoices shares = shares_of_choices(grain, normal, by_sun);
    const GrainLook look = grain_at(grain, place, normal, shares, hits.found);
    const Floats strength = strength_on(grain, normal, by_sun);
    const Floats to_sun = hn::Max(dot(normal, all_of(grain.to_sun)), all(grain_grazing));
    const Floats grainy =
        hn::MulAdd(look.to_sun, hn::Mul(strength, all(grain_slope_scale)), to_sun);
    const Floats light = hn::Div(hn::Add(hn::Max(grainy, zero), all(grain_sky_share)),
                                 hn::Add(to_sun, all(grain_sky_share)));
    const Floats scale = hn::Mul(strength, all(grain_brightness_scale));
    const auto shown = [&](Floats channel, float dry) HWY_ATTR {
        const Floats change = hn::MulAdd(look.of_grass, all(dry), look.brightness);
        const Floats brightness = hn::MulAdd(change, scale, all(1.0F));
        return hn::Mul(channel, hn::Mul(light, hn::Max(brightness, zero)));
    };
    return {shown(lit.r, dry_red), shown(lit.g, 0.0F), shown(lit.b, dry_blue)};
}

} // namespace reljef::cast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
