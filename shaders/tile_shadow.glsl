// What of the sun's light a tile's own heights leave.
#if defined(HARD_SHADOW) || defined(SOFT_SHADOW)
#define SHADOW
#include "relief_shadow.glsl"
#endif

// Share of the sun's light that reaches a place of the surface, past the surface.
float sun_share(vec2 place, mat3 space) {
#ifdef SHADOW
    vec3 direction = (local_from_relative * to_sun.xyz) * space / metres_per_unit;
    vec2 reach = most_tiles * tile_samples();
    vec2 low = mix(place - reach, vec2(-0.5), bounded);
    vec2 high = mix(place + reach, tile_samples() - 0.5, bounded);
    return sun_at(place, direction, vec3(low, -margin), vec3(high, 1.0 + margin));
#else
    return 1.0;
#endif
}
