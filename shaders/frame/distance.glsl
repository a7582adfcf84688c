// Metres from the eye to this fragment, in perspective.
#if defined(MULTISAMPLED) || defined(OVERLAY) || ((defined(POINT_LIGHTS) || defined(MESH_SHADOWS) || defined(SURFACE_SHADER)) && !defined(GROUND))
in vec3 way_from_eye; // metres
#endif

#ifdef MULTISAMPLED
float distance_to_eye() {
    return length(INSIDE(way_from_eye));
}
#else
float distance_to_eye() {
    vec2 ray = gl_FragCoord.xy * ray_from_pixel.xy + ray_from_pixel.zw;
    return sqrt(1.0 + dot(ray, ray)) / gl_FragCoord.w;
}
#endif
