// Light that reaches the eye through `distance` metres of air (Koschmieder 1924).
vec3 seen_through_air(vec3 color, float distance) {
#ifdef FOG
    return mix(sky_horizon.rgb, color, exp(-sky_horizon.a * distance));
#else
    return color;
#endif
}
