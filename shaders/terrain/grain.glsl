// Fine structure of near ground. A software renderer has no branches where pixels differ, only loops: a pattern is one
// fetch, of one layer in one plane.

// The layers of material::GrainMap. Slopes along u and v, change of the brightness: 2 · texel - 1.
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

// Shares of rock, of the level plane, and of yz in the upright ones.
vec3 shares_of_choices(GroundPlace place) {
    vec3 facing = abs(place.normal);
    return vec3(1.0 - smoothstep(rock_end, rock_begin, dot(place.normal, place.up)),
                smoothstep(upright_end, upright_begin, facing.z),
                smoothstep(-upright_turn, upright_turn, facing.x - facing.y));
}

// A pattern shows one of two looks. The line between them wanders with the noise. Above 0: the first one.
vec3 choices(vec3 shares, vec3 noise) {
    return shares - 0.5 - clamp(noise.zxy, -widest_wander, widest_wander);
}

// Near a mip level, that level alone: most pixels fetch no second one.
float steepened(float level) {
    float whole = floor(level);
    return whole + clamp((level - whole - 0.5) * level_steepness + 0.5, 0.0, 1.0);
}

// Shares of the ramp's snow, and of grass, which is green in any daylight.
vec2 shares_of_cover(vec3 lit, GroundPlace place, float height) {
    float cosine = max(dot(place.normal, place.up), 0.1);
    float line = grain_snow.w - snow_turn * clamp(dot(grain_snow.xyz, place.normal) / cosine, -1.0, 1.0);
    float high = smoothstep(line - snow_reach, line + snow_reach, height);
    high *= 1.0 - 0.9 * smoothstep(-snow_steep_begin, -snow_steep_end, -cosine);
    float green = (2.0 * lit.g - lit.r - lit.b) / max(lit.r + lit.g + lit.b, 1e-6);
    return vec2(high, smoothstep(grass_begin, grass_end, green));
}

// The layer of a narrow pattern, and how far it is from others: snow, grass, scree beside rock, or soil. Wide patterns
// are of rock or soil: their stones would be as large as houses.
vec2 kind_of_ground(float rock, vec2 cover, vec3 noise) {
    vec2 chosen = cover - 0.5 - clamp(noise.xy, -widest_wander, widest_wander);
    float scree = rock + scree_share;
    vec2 kind = scree > 0.0 ? vec2(3.0, scree) : vec2(0.0, -scree);
    kind = chosen.y > 0.0 ? vec2(2.0, chosen.y) : vec2(kind.x, min(kind.y, -chosen.y));
    kind = chosen.x > 0.0 ? vec2(4.0, chosen.x) : vec2(kind.x, min(kind.y, -chosen.x));
    return rock > 0.0 ? vec2(1.0, rock) : vec2(kind.x, min(kind.y, -rock));
}

// The change of the cosine of the angle to the sun, and of the brightness.
struct Look {
    vec2 look;
    vec3 noise; // for the choices of the next pattern
};

// `at`: in widths of the pattern; `kind`: see kind_of_ground(); `wander`: of its level. Grain fades at the lines between
// looks.
Look pattern_at(vec3 at, float level, vec3 chosen, vec2 kind, float wander, bool is_bent) {
    bool is_flat = chosen.y > 0.0;
    bool by_y = !is_flat && chosen.z > 0.0;
    vec2 place = vec2(by_y ? at.y : at.x, is_flat ? at.y : at.z);
    vec2 sun = vec2(by_y ? grain_sun.y : grain_sun.x, is_flat ? grain_sun.y : grain_sun.z);
    vec3 in_layer = vec3(is_bent ? bent(place) : place, kind.x);
    vec3 grain = 2.0 * textureLod(grain_layers, in_layer, steepened(max(level + wander, 0.0))).rgb - 1.0;
    vec3 clear = min(vec3(kind.y, abs(chosen.yz)) / choice_border, 1.0);
    float seen = clamp(last_seen_level + 1.0 - level, 0.0, 1.0);
    float strength = seen * clear.x * clear.y * (is_flat ? 1.0 : clear.z);
    return Look(strength * vec2(-dot(grain.xy, sun), grain.z), grain);
}

// The sum of the visible patterns.
vec2 grain_at(GroundPlace place, vec2 cover) {
    float longer = 1.0 / max(abs(dot(place.normal, place.view)), flattest_facing);
    float pixel = place.pixel * sqrt(longer) * sqrt(sqrt(longer)); // between its width and its length
    float texels = pixel * float(textureSize(grain_layers, 0).x);
    vec3 shares = shares_of_choices(place);
    vec4 pattern = grain_pattern_0;
    vec3 at = place.from_eye * pattern.w + pattern.xyz;
    vec3 noise = widest_noise(at);
    float wander = noise.z;
    float level = max(log2(texels * pattern.w), 0.0);
    vec2 sum = vec2(0.0);
    int i = 0;
    do {
        vec3 chosen = choices(shares, noise);
        vec2 kind = i == 0 ? vec2(chosen.x > 0.0 ? 1.0 : 0.0, abs(chosen.x)) : kind_of_ground(chosen.x, cover, noise);
        Look look = pattern_at(at, level, chosen, kind, wander, i == 0);
        sum += look.look;
        noise = look.noise;
        ++i;
        pattern = i == 1 ? grain_pattern_1 : grain_pattern_2;
        at = place.from_eye * pattern.w + pattern.xyz;
        level = max(log2(texels * pattern.w), 0.0);
    } while (i < int(grain_turn.z) && level < last_seen_level + 1.0);
    return sum;
}

// Snow, of the ramp or as the brightest ground, is smoother, and level water has no grain.
float strength_on(vec3 lit, GroundPlace place, float snow) {
    float bright = smoothstep(snow_begin, snow_end, dot(lit, vec3(0.2126, 0.7152, 0.0722)));
    float rough = 1.0 - snow_smoothness * max(snow, bright);
    bool is_level = dot(place.normal, place.up) > level_cosine;
    return is_level && lit.b > blue_of_water * lit.r ? 0.0 : grain_up.w * rough;
}

// Ground with its grain: slopes change the share of the sun's light, and the brightness changes all light. Ground that
// the sun hardly reaches is as grainy as if it did: else the steps of normals from cell to cell would show.
// `height`: true metres.
vec3 with_grain(vec3 lit, GroundPlace place, float height) {
    vec2 cover = shares_of_cover(lit, place, height);
    vec2 grain = grain_at(place, cover);
    float strength = strength_on(lit, place, cover.x);
    float to_sun = max(dot(place.normal, grain_sun.xyz), grain_grazing);
    float grainy = to_sun + strength * grain_slope_scale * grain.x;
    float light = (max(grainy, 0.0) + grain_sky_share) / (to_sun + grain_sky_share);
#ifdef POINT_LIGHTS
    lit += light_under_overlay;
#endif
    return lit * light * max(1.0 + strength * grain_brightness_scale * grain.y, 0.0);
}
