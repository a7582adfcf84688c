// Self-shadowing of a relief tile.
#if defined(HARD_SHADOW) || defined(SOFT_SHADOW)
#define SHADOW
#include "relief/relief_shadow.glsl"

// A pixel that covers several samples tests some in a row. Between these mip levels of the height map it
// blends to the mean of the tile.
const float places_of_a_pixel = 4.0;
const vec2 mean_levels = vec2(2.0, 5.0);

// Mean visibility of the sun for normally distributed slopes (Smith 1967), as a rational function
// (Walter, Marschner, Li and Torrance 2007). `direction`: samples and height.
float mean_sun_share(vec3 direction) {
    float a = max(direction.z, 0.0) / max(sqrt(2.0) * length(direction.xy * rms_rise), 1e-30);
    return a < 1.6 ? a * (3.535 + 2.181 * a) / (1.0 + a * (2.276 + 2.577 * a)) : 1.0;
}

// `row`: the longer side of the pixel, in samples.
float sun_share_along(vec2 row, vec2 place, vec3 direction, float places) {
    vec2 reach = max_tiles * tile_samples();
    vec2 low = mix(place - reach, vec2(-0.5), bounded);
    vec2 high = mix(place + reach, tile_samples() - 0.5, bounded);
    float sum = 0.0;
    for (float i = 0.5; i < places; ++i) {
        vec2 at = clamp(place + (i / places - 0.5) * row, low, high);
        sum += sun_at(at, direction, vec3(low, -margin), vec3(high, 1.0 + margin));
    }
    return sum / places;
}
#endif

// Visible share of the sun at a place of the relief. `right`, `up`: change of the tile coordinate per
// pixel.
float sun_share(vec2 place, mat3 space, vec2 right, vec2 up) {
#ifdef SHADOW
    vec3 to_light = (local_from_relative * to_sun.xyz) * space;
    vec3 direction =
        vec3(to_light.xy * tiles_per_metre * tile_samples(), to_light.z / metres_per_unit.z);
    float level = level_of(height_map, right, up);
#ifdef LAYERS
    float mean_part = 0.0; // layers have no mean slope
    float places = 1.0;
#else
    float mean_part = smoothstep(mean_levels.x, mean_levels.y, level);
    float places = level > 0.0 ? places_of_a_pixel : 1.0;
#endif
    float share = mean_part > 0.0 ? mean_part * mean_sun_share(direction) : 0.0;
    if (mean_part < 1.0) {
        vec2 row = (dot(right, right) > dot(up, up) ? right : up) * tile_samples();
        share += (1.0 - mean_part) * sun_share_along(row, place, direction, places);
    }
    return share;
#else
    return 1.0;
#endif
}
