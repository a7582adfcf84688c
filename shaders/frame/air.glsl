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

// Spreads the error of 8 bits over neighbouring pixels (interleaved gradient noise, Jimenez 2014). 2.1 times
// the root is nearly the derivative of linear light by its sRGB value.
vec3 dithered(vec3 linear) {
    vec2 place = mod(floor(gl_FragCoord.xy) + pixel_share.zw, 64.0);
    float noise = fract(52.9829189 * fract(dot(place, vec2(0.06711056, 0.00583715))));
    return linear + (noise - 0.5) / 255.0 * 2.1 * sqrt(max(linear, 0.0));
}

// The fragment's light after absorption and scattering by the air, to be written as 8 bits.
vec3 seen_through_air(vec3 color, float metres) {
#ifdef FOG
    return dithered(through_air(color, normalize(pixel_ray()), metres));
#else
    return dithered(color);
#endif
}
