// Metres from the eye to this fragment, in perspective.
float distance_to_eye() {
    vec2 ray = gl_FragCoord.xy * ray_from_pixel.xy + ray_from_pixel.zw;
    return sqrt(1.0 + dot(ray, ray)) / gl_FragCoord.w;
}

// What is left of the fragment's light at the eye, and the air's own added (Koschmieder 1924).
vec3 seen_through_air(vec3 color, float metres) {
#ifdef FOG
    return mix(sky_horizon.rgb, color, exp(-sky_horizon.a * metres));
#else
    return color;
#endif
}
