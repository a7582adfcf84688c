// Diffuse reflection. `visibility`: visible share of the sun's disc.
vec3 lit_color(vec3 albedo, vec3 normal, float visibility) {
#ifdef LIT
    float sun = max(dot(normal, to_sun.xyz), 0.0) * visibility;
    float sky = 0.5 + 0.5 * normal.z;
    return albedo * (sun_color.rgb * sun + ambient_color.rgb * sky);
#else
    return albedo;
#endif
}
