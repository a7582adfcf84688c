#include "frame/frame_block.glsl"
#include "frame/air.glsl"
#include "frame/fragment.glsl"
#include "frame/distance.glsl"

in vec2 tile_place;
#ifdef HIT
in vec2 height_and_depth;
#endif

uniform vec2 tile_sample;     // col, row of the tile's first sample
uniform vec4 lit_from_sample; // texture coordinate = sample · xy + zw

layout(binding = lit_map_unit) uniform sampler2D lit_map; // reflected light, linear
#ifdef WARPED
// Visible column, row (< 0: none) and height per sample.
layout(binding = warped_places_unit) uniform sampler2D warped_places;
#endif

#ifdef HIT
layout(location = 0) out vec4 hit; // col, row, height, depth
#else
layout(location = 0) out vec4 color;
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
#elif defined(HIT)
    hit = vec4(place, height_and_depth);
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
}
