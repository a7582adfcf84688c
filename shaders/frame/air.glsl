// The fragment's light after absorption and scattering by the air (Koschmieder 1924).
vec3 seen_through_air(vec3 color, float metres) {
#ifdef FOG
    return mix(sky_horizon.rgb, color, exp(-sky_horizon.a * metres));
#else
    return color;
#endif
}
