// In perspective, the view ray through this pixel or sample, at depth 1; relative to the eye.
vec3 pixel_ray() {
#if defined(MULTISAMPLED) && defined(PER_SAMPLE)
    vec2 pixel = floor(gl_FragCoord.xy) + gl_SamplePosition; // gl_FragCoord may be anywhere in the pixel
#else
    vec2 pixel = gl_FragCoord.xy;
#endif
    vec2 place = pixel * pixel_share.xy;
    return ray_corner.xyz + place.x * ray_right.xyz + place.y * ray_up.xyz;
}
