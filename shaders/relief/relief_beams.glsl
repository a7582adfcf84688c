// A relief's rays begin where their beam may first meet something.
layout(binding = 5) uniform sampler2D clear_heights; // of each block of pixels: beams.frag
uniform int pixels_a_block;

// As a part of the ray.
float clear_part(vec3 start, vec3 span) {
    float clear = texelFetch(clear_heights, ivec2(gl_FragCoord.xy) / pixels_a_block, 0).r;
    return span.z < 0.0 ? clamp((clear - start.z) / span.z, 0.0, 1.0) : 0.0;
}
