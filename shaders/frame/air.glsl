#include "frame/pixel_ray.glsl"

// The 8th power of the cosine of the angle to the sun: forward scattering.
// 0 without a sun.
float toward_sun(vec3 direction) {
    float toward = max(dot(direction, to_sun.xyz), 0.0);
    toward *= toward;
    toward *= toward;
    return toward * toward;
}

vec3 haze_color(vec3 direction) {
    return sky_horizon.rgb + sky_glow.rgb * toward_sun(direction);
}

// A colour behind air whose density falls exponentially with height (Koschmieder 1924). `direction`: unit.
vec3 through_air(vec3 color, vec3 direction, float metres) {
    float eye_density = sky_glow.a;
    float above = max(sky_plane.a + (dot(direction, air_up.xyz) + air_up.w * metres) * metres, 0.0);
    float density = exp(-above * air.a);
    float rise = (above - sky_plane.a) * air.a;
    float mean = abs(rise) < 0.1 ? 0.5 * (eye_density + density) : (eye_density - density) / rise;
    vec3 left = exp(-air.rgb * (mean * metres));
    return mix(haze_color(direction), color, left);
}

// The fragment's light after absorption and scattering by the air.
vec3 seen_through_air(vec3 color, float metres) {
#ifdef FOG
    return through_air(color, normalize(pixel_ray()), metres);
#else
    return color;
#endif
}
