#include "frame/frame_block.glsl"
#include "frame/air.glsl"
#include "frame/fragment.glsl"
#include "frame/distance.glsl"
#include "frame/count.glsl"

in vec2 tile_place;
#ifdef HIT
in vec2 place_from_eye;
in vec2 height_and_depth;

uniform vec4 eye_sample; // xy: col, row; zw: to be added
#endif

uniform vec2 tile_sample;     // col, row of the tile's first sample
uniform vec4 lit_from_sample; // texture coordinate = sample · xy + zw

layout(binding = lit_map_unit) uniform sampler2D lit_map; // reflected light, linear
#ifdef WARPED
// Visible column, row (< 0: none) and height per sample.
layout(binding = warped_places_unit) uniform sampler2D warped_places;
#endif

#include "frame/output.glsl"

#if defined(HIT) && !defined(WARPED)
// `origin` plus `offset` as two floats (Knuth's two-sum).
void write_place(vec4 origin, vec2 offset) {
    precise vec2 sum = origin.xy + offset;
    precise vec2 added = sum - origin.xy;
    precise vec2 low = ((origin.xy - (sum - added)) + (offset - added)) + origin.zw;
    precise vec2 high = sum + low;
    precise vec2 rest = low - (high - sum);
    hit = vec4(high, height_and_depth);
    hit_low = rest;
}
#endif

void main() {
    vec2 place = tile_sample + INSIDE(tile_place);
#ifdef WARPED
    vec2 coordinate = (tile_sample + tile_place) * lit_from_sample.xy;
    vec2 across = dFdx(coordinate);
    vec2 down = dFdy(coordinate);
    vec2 texel = 1.0 / vec2(textureSize(warped_places, 0));
    vec3 seen = textureLod(warped_places, (place + 0.5) * texel, 0.0).xyz;
    place = seen.xy;
    if (place.x < 0.0) {
        discard;
    }
#endif
#if defined(HIT) && defined(WARPED)
    hit = vec4(seen, height_and_depth.y);
    hit_low = vec2(0.0);
#elif defined(HIT)
    // Floats round places by a share of their distance from the origin, which walls show as their height.
    bool is_near_eye = dot(place_from_eye, place_from_eye) < dot(tile_place, tile_place);
    write_place(is_near_eye ? eye_sample : vec4(tile_sample, 0.0, 0.0),
                is_near_eye ? place_from_eye : tile_place);
#elif defined(WARPED)
    vec3 lit =
        textureGrad(lit_map, place * lit_from_sample.xy + lit_from_sample.zw, across, down).rgb;
#elif defined(MULTISAMPLED)
    vec3 lit = textureGrad(lit_map, place * lit_from_sample.xy + lit_from_sample.zw,
                           dFdx(tile_place) * lit_from_sample.xy,
                           dFdy(tile_place) * lit_from_sample.xy)
                   .rgb;
#else
    vec3 lit = texture(lit_map, place * lit_from_sample.xy + lit_from_sample.zw).rgb;
#endif
#ifndef HIT
    color = vec4(seen_through_air(lit, distance_to_eye()), 1.0);
#endif
#ifdef COUNT
#ifdef WARPED
    count_taps(1.0);
#endif
    count_taps(1.0);
    work = vec4(work_taps, work_steps, work_rays, 1.0);
#endif
}
