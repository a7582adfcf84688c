#include "relief/relief_walk.glsl"

// Over a finite surface.
bool is_endless(vec3 start, vec3 span) {
    return false;
}

ivec2 first_cell(inout vec3 start) {
    return clamp(ivec2(floor(start.xy)) + origin_cell, ivec2(0), last_cell);
}

vec2 exits_of(vec3 start, vec2 inverse, ivec2 forward, Walk walk) {
    vec2 border = vec2(((walk.block + forward) << walk.level) - origin_cell);
    return max((border - start.xy) * inverse, walk.part);
}

bool stays(inout vec3 start, inout Walk walk) {
    ivec2 beyond = last_cell >> walk.level;
    return all(greaterThanEqual(walk.block, ivec2(0))) && all(lessThanEqual(walk.block, beyond));
}

ivec2 existing(ivec2 block, int level) {
    return min(block, last_cell >> level);
}

float max_height_in(Walk walk) {
    count_taps(1.0);
    return texelFetch(max_mipmap, walk.block, walk.level).r;
}

#ifndef CONE
bool find_hit(vec3 start, vec3 span, out float part, out vec2 place) {
    return find_exact_hit(start, span, part, place);
}
#endif
