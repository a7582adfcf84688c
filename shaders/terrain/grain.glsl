// Fine structure of near ground, as packets of rays paint it (packet_grain-inl.h).
// Slopes along u and v, change of the brightness: 2 · texel - 1.
layout(binding = soil_grain_unit) uniform sampler2D soil_grain;
layout(binding = rock_grain_unit) uniform sampler2D rock_grain;

vec3 along_turned_axes(vec3 world) {
    return vec3(dot(grain_turn.xy, world.xy), grain_turn.x * world.y - grain_turn.y * world.x, world.z);
}

vec3 grain_in(sampler2D map, vec2 place, float level) {
    return 2.0 * textureLod(map, place, level).rgb - 1.0;
}

// A sine of amplitude 1 and period 1, but of parabolas.
vec2 wave(vec2 x) {
    vec2 part = x - round(x);
    return 8.0 * part * (1.0 - 2.0 * abs(part));
}

// The widest pattern, bent: view::GrainView::copies.
vec2 bent(vec2 place) {
    return place + 0.2 * (wave(place.yx / 7.0) + wave(place.yx / 11.0 + 0.3));
}

// What a pattern changes: x: the cosine of the angle to the sun; y: the brightness. `sun`: along its axes.
vec2 pattern_at(vec2 place, float level, float rock, vec2 sun) {
    vec3 soil = rock < 1.0 ? grain_in(soil_grain, place, level) : vec3(0.0);
    vec3 stone = rock > 0.0 ? grain_in(rock_grain, place, level) : vec3(0.0);
    vec3 grain = mix(soil, stone, rock);
    return vec2(-dot(grain.xy, sun), grain.z);
}

// The sum of all patterns, as far as they are seen: in the level plane, and in the upright one that the ground faces
// most. `pixel`: its width on the ground, metres.
vec2 grain_at(vec3 from_eye, vec3 normal, float pixel) {
    const float last_seen = 5.0; // level: the longest waves are two pixels long
    vec4 patterns[3] = vec4[3](grain_pattern_0, grain_pattern_1, grain_pattern_2);
    float rock = 1.0 - smoothstep(0.76, 0.90, dot(normal, grain_up.xyz));
    float level_plane = smoothstep(0.6, 0.75, abs(normal.z));
    bool faces_y = abs(normal.x) < abs(normal.y);
    vec2 upright_sun = faces_y ? grain_sun.xz : grain_sun.yz;
    vec2 sum = vec2(0.0);
    for (int i = 0; i < int(grain_turn.z); ++i) {
        vec4 pattern = patterns[i];
        float level = max(log2(pixel * pattern.w * float(textureSize(soil_grain, 0).x)), 0.0);
        float seen = clamp(last_seen + 1.0 - level, 0.0, 1.0);
        if (seen == 0.0) {
            continue;
        }
        vec3 at = from_eye * pattern.w + pattern.xyz;
        if (level_plane > 0.0) {
            vec2 place = i == 0 ? bent(at.xy) : at.xy;
            sum += seen * level_plane * pattern_at(place, level, rock, grain_sun.xy);
        }
        if (level_plane < 1.0) {
            vec2 place = faces_y ? at.xz : at.yz;
            place = i == 0 ? bent(place) : place;
            sum += seen * (1.0 - level_plane) * pattern_at(place, level, rock, upright_sun);
        }
    }
    return sum;
}

// Snow, the brightest ground, is smoother, and level water has none.
float strength_on(vec3 lit, vec3 normal) {
    const float blue_of_water = 2.0; // times its red
    float luminance = dot(lit, vec3(0.2126, 0.7152, 0.0722));
    float rough = 1.0 - 0.8 * smoothstep(0.35, 0.65, luminance);
    bool is_level = dot(normal, grain_up.xyz) > 0.99999;
    return is_level && lit.b > blue_of_water * lit.r ? 0.0 : grain_up.w * rough;
}

// Ground with its grain: slopes change the share of the sun's light, and the brightness changes all. Ground that the
// sun hardly reaches is as grainy as if it did: else the steps of normals from cell to cell would show. `relative`: from
// the eye, world metres; `perpendicular`: to the surface, along the turned axes.
vec3 with_grain(vec3 lit, vec3 relative, vec3 perpendicular) {
    const float sky_share = 0.45; // of the sun's light on ground that faces it
    const float grazing = 0.2;    // cosine of the angle to the sun
    const float slope_scale = 0.55;
    const float brightness_scale = 0.35;
    vec3 from_eye = along_turned_axes(relative);
    float area = length(perpendicular);
    vec3 normal = area > 0.0 ? perpendicular / area : grain_up.xyz;
    normal *= dot(normal, grain_up.xyz) < 0.0 ? -1.0 : 1.0;
    float distance = max(length(from_eye), 1e-30);
    float facing = abs(dot(normal, from_eye)) / distance;
    float pixel = metres_a_pixel.x + metres_a_pixel.y * distance;
    vec2 grain = grain_at(from_eye, normal, pixel * inversesqrt(max(facing, 0.0625)));
    float strength = strength_on(lit, normal);
    float to_sun = max(dot(normal, grain_sun.xyz), grazing);
    float grainy = to_sun + strength * slope_scale * grain.x;
    float light = (max(grainy, 0.0) + sky_share) / (to_sun + sky_share);
    return lit * light * max(1.0 + strength * brightness_scale * grain.y, 0.0);
}
