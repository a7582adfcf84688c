#include "relief/relief_cell.glsl"
#include "relief/relief_walk.glsl"

// Over an infinite tile: repeated, with cells between the copies, or clamped at its border.

// Infinite or NaN without a tangent frame of the mesh.
bool is_endless(vec3 start, vec3 span) {
    float sum = dot(abs(start) + abs(span), vec3(1.0));
    return isnan(sum) || sum > 1e30;
}

ivec2 first_cell(inout vec3 start) {
#ifdef WRAP
    vec2 cells = vec2(last_cell + 1);
    start.xy -= cells * floor(start.xy / cells);
    return min(ivec2(start.xy), last_cell);
#else
    return ivec2(floor(start.xy));
#endif
}

vec2 exits_of(vec3 start, vec2 inverse, ivec2 forward, Walk walk) {
    ivec2 border = (walk.block + forward) << walk.level;
#ifdef WRAP
    border = min(border, last_cell + 1);
#endif
    return max((vec2(border) - start.xy) * inverse, walk.part);
}

// In the next copy the ray moves back over the tile.
bool stays(inout vec3 start, inout Walk walk) {
#ifdef WRAP
    ivec2 beyond = last_cell >> walk.level;
    ivec2 copy = ivec2(greaterThan(walk.block, beyond)) - ivec2(lessThan(walk.block, ivec2(0)));
    start.xy -= vec2(copy * (last_cell + 1));
    walk.block -= copy * (beyond + 1);
#endif
    return true;
}

ivec2 existing(ivec2 block, int level) {
#ifdef WRAP
    return min(block, last_cell >> level);
#else
    return block;
#endif
}

float max_height_in(Walk walk) {
    count_taps(1.0);
    ivec2 block = clamp(walk.block, ivec2(0), last_cell >> walk.level);
    return texelFetch(max_mipmap, block, walk.level).r;
}

#ifndef CONE
bool find_hit(vec3 start, vec3 span, out float part, out vec2 place) {
    return find_exact_hit(start, span, part, place);
}
#endif
