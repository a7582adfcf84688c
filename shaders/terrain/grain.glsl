// Fine structure of near ground.

// Slopes along u and v, change of the brightness: 2 · texel - 1.
layout(binding = soil_grain_unit) uniform sampler2D soil_grain;
layout(binding = rock_grain_unit) uniform sampler2D rock_grain;

vec3 grain_in(sampler2D map, vec2 place, float level) {
    return 2.0 * textureLod(map, place, level).rgb - 1.0;
}

// A sine of amplitude 1 and period 1, but of parabolas.
vec2 wave(vec2 x) {
    vec2 part = x - round(x);
    return 8.0 * part * (1.0 - 2.0 * abs(part));
}

// The widest pattern is bent: view::GrainView::copies.
vec2 bent(vec2 place) {
    return place + bend_height * (wave(place.yx / 7.0) + wave(place.yx / 11.0 + 0.3));
}

// The change of the cosine of the angle to the sun, and of the brightness. `sun`: in the pattern's plane.
vec2 pattern_at(vec2 place, float level, float rock, vec2 sun) {
    vec3 soil = rock < 1.0 ? grain_in(soil_grain, place, level) : vec3(0.0);
    vec3 stone = rock > 0.0 ? grain_in(rock_grain, place, level) : vec3(0.0);
    vec3 grain = mix(soil, stone, rock);
    return vec2(-dot(grain.xy, sun), grain.z);
}

// Shares of the planes xz, yz and xy.
vec3 shares_of_planes(vec3 normal) {
    vec3 facing = abs(normal);
    float level = smoothstep(upright_end, upright_begin, facing.z);
    float along_y = smoothstep(-upright_turn, upright_turn, facing.x - facing.y);
    return vec3((1.0 - level) * (1.0 - along_y), (1.0 - level) * along_y, level);
}

// The sum of the visible patterns.
vec2 grain_at(GroundPlace place) {
    vec4 patterns[3] = vec4[3](grain_pattern_0, grain_pattern_1, grain_pattern_2);
    float longer = 1.0 / max(abs(dot(place.normal, place.view)), flattest_facing);
    float pixel = place.pixel * sqrt(longer) * sqrt(sqrt(longer)); // between its width and its length
    float rock = 1.0 - smoothstep(rock_end, rock_begin, dot(place.normal, place.up));
    vec3 planes = shares_of_planes(place.normal);
    vec3 sun = grain_sun.xyz;
    vec2 sum = vec2(0.0);
    for (int i = 0; i < int(grain_turn.z); ++i) {
        vec4 pattern = patterns[i];
        float level = max(log2(pixel * pattern.w * float(textureSize(soil_grain, 0).x)), 0.0);
        float seen = clamp(last_seen_level + 1.0 - level, 0.0, 1.0);
        if (seen == 0.0) {
            continue;
        }
        vec3 at = place.from_eye * pattern.w + pattern.xyz;
        vec2 places[3] = vec2[3](at.xz, at.yz, at.xy);
        vec2 suns[3] = vec2[3](sun.xz, sun.yz, sun.xy);
        for (int plane = 0; plane < 3; ++plane) {
            if (planes[plane] > 0.0) {
                vec2 on = i == 0 ? bent(places[plane]) : places[plane];
                sum += seen * planes[plane] * pattern_at(on, level, rock, suns[plane]);
            }
        }
    }
    return sum;
}

// Snow, the brightest ground, is smoother, and level water has no grain.
float strength_on(vec3 lit, GroundPlace place) {
    float luminance = dot(lit, vec3(0.2126, 0.7152, 0.0722));
    float rough = 1.0 - snow_smoothness * smoothstep(snow_begin, snow_end, luminance);
    bool is_level = dot(place.normal, place.up) > level_cosine;
    return is_level && lit.b > blue_of_water * lit.r ? 0.0 : grain_up.w * rough;
}

// Ground with its grain: slopes change the share of the sun's light, and the brightness changes all light. Ground that
// the sun hardly reaches is as grainy as if it did: else the steps of normals from cell to cell would show.
vec3 with_grain(vec3 lit, GroundPlace place) {
    vec2 grain = grain_at(place);
    float strength = strength_on(lit, place);
    float to_sun = max(dot(place.normal, grain_sun.xyz), grain_grazing);
    float grainy = to_sun + strength * grain_slope_scale * grain.x;
    float light = (max(grainy, 0.0) + grain_sky_share) / (to_sun + grain_sky_share);
    return lit * light * max(1.0 + strength * grain_brightness_scale * grain.y, 0.0);
}
