// Of this pixel or sample, from the lower left corner.
vec2 share_of_picture() {
#if defined(MULTISAMPLED) && defined(PER_SAMPLE)
    vec2 pixel = floor(gl_FragCoord.xy) + gl_SamplePosition; // gl_FragCoord may be anywhere in the pixel
#else
    vec2 pixel = gl_FragCoord.xy;
#endif
    return pixel * pixel_share.xy;
}

// In perspective, the view ray through it, at depth 1; relative to the eye.
vec3 pixel_ray() {
    vec2 place = share_of_picture();
    return ray_corner.xyz + place.x * ray_right.xyz + place.y * ray_up.xyz;
}
