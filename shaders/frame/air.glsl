// What is left of the fragment's light at the eye, and the air's own added (Koschmieder 1924).
vec3 seen_through_air(vec3 color, float metres) {
#ifdef FOG
    return mix(sky_horizon.rgb, color, exp(-sky_horizon.a * metres));
#else
    return color;
#endif
}
