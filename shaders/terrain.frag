#include "frame_block.glsl"
#include "air.glsl"

in vec2 tile_place;
#ifdef HIT
in vec2 height_and_depth;
#endif

uniform vec2 tile_sample;     // col, row of the tile's first sample
uniform vec4 lit_from_sample; // texture coordinate = sample · xy + zw

layout(binding = 0) uniform sampler2D lit_map; // what the surface sends to the eye, linear

#ifdef HIT
layout(location = 0) out vec4 hit; // col, row, height, depth
#else
layout(location = 0) out vec4 color;
#endif

void main() {
    vec2 place = tile_sample + tile_place;
#ifdef HIT
    hit = vec4(place, height_and_depth);
#else
    vec3 lit = texture(lit_map, place * lit_from_sample.xy + lit_from_sample.zw).rgb;
    color = vec4(seen_through_air(lit, distance_to_eye()), 1.0);
#endif
}
