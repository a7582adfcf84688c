// Rays begin where their beam may hit.
layout(binding = clear_heights_unit) uniform sampler2D clear_heights; // per block of pixels: beams.frag

#ifdef CURVED
// `along`: the ray, metres of depth.
float clear_part(float along) {
    count_taps(1.0);
    return texelFetch(clear_heights, ivec2(gl_FragCoord.xy) / pixels_a_beam, 0).r / along;
}
#else
// The free part of the ray.
float clear_part(vec3 start, vec3 span) {
    count_taps(1.0);
    float clear = texelFetch(clear_heights, ivec2(gl_FragCoord.xy) / pixels_a_beam, 0).r;
    return span.z < 0.0 ? clamp((clear - start.z) / span.z, 0.0, 1.0) : 0.0;
}
#endif
