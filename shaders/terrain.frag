#include "frame_block.glsl"
#include "surface_light.glsl"
#include "air.glsl"

in vec2 tile_place;
#ifdef HIT
in vec2 height_and_depth;
#endif

uniform vec4 tile_samples;
uniform vec4 color_from_sample;    // texture coordinate = sample · xy + zw
uniform vec4 gradient_from_sample;
uniform mat3 world_from_terrain;

layout(binding = 0) uniform sampler2D color_map;    // rgb: albedo, a: share of the sun that is seen
layout(binding = 1) uniform sampler2D gradient_map; // rise over run east and north, terrain frame

#ifdef HIT
layout(location = 0) out vec4 hit; // col, row, height, depth
#else
layout(location = 0) out vec4 color;
#endif

void main() {
    vec2 place = tile_samples.xy + tile_place;
#ifdef HIT
    hit = vec4(place, height_and_depth);
#else
    vec4 texel = texture(color_map, place * color_from_sample.xy + color_from_sample.zw);
    vec3 lit = texel.rgb;
#ifdef LIT
    vec2 gradient = texture(gradient_map, place * gradient_from_sample.xy + gradient_from_sample.zw).xy;
    vec3 normal = normalize(world_from_terrain * vec3(-gradient, 1.0));
    lit = lit_color(texel.rgb, normal, texel.a);
#endif
    color = vec4(seen_through_air(lit), 1.0);
#endif
}
