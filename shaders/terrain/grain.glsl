// Fine structure of near ground. A software renderer has no branches where pixels differ, only loops: a pattern is one
// fetch, of one layer in one plane.

// Soil, scree, grass, rock and snow. Slopes along u and v, change of the brightness: 2 · texel - 1.
layout(binding = grain_layers_unit) uniform sampler2DArray grain_layers;

// A sine of amplitude 1 and period 1, but of parabolas.
vec3 wave(vec3 x) {
    vec3 part = x - round(x);
    return 8.0 * part * (1.0 - 2.0 * abs(part));
}

vec2 wave(vec2 x) {
    return wave(x.xyy).xy;
}

// The widest pattern is bent: view::GrainView::copies.
vec2 bent(vec2 place) {
    return place + bend_height * (wave(place.yx / 7.0) + wave(place.yx / 11.0 + 0.3));
}

// Noise that the mip levels follow, and the choices of the widest pattern; those of the others follow the pattern
// before.
vec3 widest_noise(vec3 at) {
    const mat3 turns = mat3(99.0, 42.0, 110.0, -66.0, 98.0, 56.0, 35.0, -99.0, 84.0) / 77.0; // view::GrainView::copies
    vec3 waves = wave(at * turns);
    return choice_noise * (waves + waves.yzx);
}

// Shares of scree, grass, rock and snow; ground that is none of them is soil. Colours count as on level ground. Excess
// green: Woebbecke et al. 1995.
vec4 kinds_of(vec3 lit, GroundPlace place) {
    vec3 color = lit * grain_light.rgb + vec3(dark_red, dark_green, 0.0);
    float sum = color.r + color.g + color.b;
    return vec4(smoothstep(scree_begin, scree_end, (color.b - color.r) / sum),
                smoothstep(grass_begin, grass_end, 3.0 * color.g / sum - 1.0),
                1.0 - smoothstep(rock_end, rock_begin, dot(place.normal, place.up)),
                smoothstep(snow_begin, snow_end, 3.0 * color.b * color.b / sum));
}

// Shares of the level plane, and of yz in the upright ones.
vec2 shares_of_planes(GroundPlace place) {
    vec3 facing = abs(place.normal);
    return vec2(smoothstep(upright_end, upright_begin, facing.z),
                smoothstep(-upright_turn, upright_turn, facing.x - facing.y));
}

// A pattern shows one of two looks. The line between them wanders with the noise. Above 0: the first one.
vec2 choices(vec2 shares, vec2 noise) {
    return shares - 0.5 - clamp(noise, -widest_wander, widest_wander);
}

vec4 choices(vec4 shares, vec4 noise) {
    return shares - 0.5 - clamp(noise, -widest_wander, widest_wander);
}

// The last kind that was chosen.
float layer_of(vec4 chosen) {
    float layer = chosen.x > 0.0 ? scree_layer : 0.0;
    layer = chosen.y > 0.0 ? grass_layer : layer;
    layer = chosen.z > 0.0 ? rock_layer : layer;
    return chosen.w > 0.0 ? snow_layer : layer;
}

// Near a mip level, that level alone: most pixels fetch no second one.
float steepened(float level) {
    float whole = floor(level);
    return whole + clamp((level - whole - 0.5) * level_steepness + 0.5, 0.0, 1.0);
}

// The change of the cosine of the angle to the sun, of the brightness, and of the grass's alone.
struct Look {
    vec3 look;
    vec3 noise; // for the choices of the next pattern
};

// `at`: in widths of the pattern; `wander`: of its level. Grain fades at the lines between planes; kinds of ground have
// the same noise.
Look pattern_at(vec3 at, float level, float layer, vec2 chosen, float wander, bool is_bent) {
    bool is_flat = chosen.x > 0.0;
    bool by_y = !is_flat && chosen.y > 0.0;
    vec2 place = vec2(by_y ? at.y : at.x, is_flat ? at.y : at.z);
    vec2 sun = vec2(by_y ? grain_sun.y : grain_sun.x, is_flat ? grain_sun.y : grain_sun.z);
    vec3 in_layer = vec3(is_bent ? bent(place) : place, layer);
    vec3 grain = 2.0 * textureLod(grain_layers, in_layer, steepened(max(level + wander, 0.0))).rgb - 1.0;
    vec2 clear = min(abs(chosen) / choice_border, 1.0);
    float seen = clamp(last_seen_level + 1.0 - level, 0.0, 1.0);
    float strength = seen * clear.x * (is_flat ? 1.0 : clear.y);
    return Look(strength * vec3(-dot(grain.xy, sun), grain.z, layer == grass_layer ? grain.z : 0.0), grain);
}

// The sum of the visible patterns.
vec3 grain_at(GroundPlace place, vec4 kinds) {
    float longer = 1.0 / max(abs(dot(place.normal, place.view)), flattest_facing);
    float pixel = place.pixel * sqrt(longer) * sqrt(sqrt(longer)); // between its width and its length
    float texels = pixel * float(textureSize(grain_layers, 0).x);
    vec2 shares = shares_of_planes(place);
    vec4 pattern = grain_pattern_0;
    vec3 at = place.from_eye * pattern.w + pattern.xyz;
    vec3 noise = widest_noise(at);
    float wander = noise.z;
    float level = max(log2(texels * pattern.w), 0.0);
    vec3 sum = vec3(0.0);
    int i = 0;
    do {
        float layer = layer_of(choices(kinds, vec4(noise, -noise.y)));
        Look look = pattern_at(at, level, layer, choices(shares, noise.xy), wander, i == 0);
        sum += look.look;
        noise = look.noise;
        ++i;
        pattern = i == 1 ? grain_pattern_1 : grain_pattern_2;
        at = place.from_eye * pattern.w + pattern.xyz;
        level = max(log2(texels * pattern.w), 0.0);
    } while (i < int(grain_turn.z) && level < last_seen_level + 1.0);
    return sum;
}

// The contrast of grain. Level water has none.
float strength_on(vec3 lit, GroundPlace place) {
    bool is_level = dot(place.normal, place.up) > level_cosine;
    return is_level && lit.b > blue_of_water * lit.r ? 0.0 : grain_up.w;
}

// Ground with its grain: slopes change the share of the sun's light, and the brightness changes all light. Ground that
// the sun hardly reaches is as grainy as if it did: else the steps of normals from cell to cell would show.
vec3 with_grain(vec3 lit, GroundPlace place) {
    vec3 grain = grain_at(place, kinds_of(lit, place));
    float strength = strength_on(lit, place);
    float to_sun = max(dot(place.normal, grain_sun.xyz), grain_grazing);
    float grainy = to_sun + strength * grain_slope_scale * grain.x;
    float light = (max(grainy, 0.0) + grain_sky_share) / (to_sun + grain_sky_share);
    vec3 brightness = grain.y + grain.z * vec3(dry_red, 0.0, dry_blue);
#ifdef POINT_LIGHTS
    lit += light_under_overlay;
#endif
    return lit * light * max(1.0 + strength * grain_brightness_scale * brightness, 0.0);
}
