#include "frame/technique_block.glsl"
#include "frame/count.glsl"

// The searched surface: x column, y row, z height in [0,1].
#ifndef STREAMED
layout(binding = height_map_unit) uniform sampler2D height_map;
#endif
uniform vec2 height_texel; // 1 / samples
#if defined(TILE)
const ivec2 origin_cell = ivec2(0);
#elif !defined(STREAMED)
uniform ivec2 origin_cell; // at (0, 0) of the search space: near the eye, where floats are precise
#endif
#ifdef TILE
vec3 metres_per_unit = vec3(1.0); // of the search space at this fragment
bool is_off_tile(vec2 coordinate); // tile_surface.glsl
#else
#include "frame/relief_block.glsl"
#ifdef CURVED
#include "curved/curved_rays.glsl"
vec3 metres_per_unit = space_scale.xyz; // along this fragment's ray
#else
#define metres_per_unit space_scale.xyz
#endif
#endif

#ifdef CURVED
vec3 ray_at(vec3 start, vec3 span, float part) {
    return curve_at(mix(curve_range.x, curve_range.y, part));
}
#else
vec3 ray_at(vec3 start, vec3 span, float part) {
    return start + part * span;
}
#endif

// Cosine of a ray's angle to the vertical; 0 of a ray without length.
float uprightness(vec3 span) {
    vec3 way = span * metres_per_unit;
    return min(abs(way.z) / max(length(way), 1e-30), 1.0);
}

#ifdef LAYERS
// Solid between 1 and 2, and between 3 and 4.
vec4 layers_at(vec2 place) {
    count_taps(1.0);
    return textureLod(height_map, (place + 0.5) * height_texel, 0.0);
}

// Depth in a solid; negative outside.
float depth_between(vec4 layers, float height) {
    vec2 depths = min(layers.xz - height, height - layers.yw);
    return max(depths.x, depths.y);
}

int hit_layer = 0; // of the last hit

float height_at(vec2 place) {
    return layers_at(place)[hit_layer];
}

float depth_in_surface(vec3 point) {
    return depth_between(layers_at(point.xy), point.z);
}

// 1 up, -1 down.
float outward() {
    return (hit_layer & 1) == 0 ? 1.0 : -1.0;
}
#else
#ifdef STREAMED
#include "stream/stream_tiles.glsl"
#else
float height_at(vec2 place) {
    count_taps(1.0);
    return textureLod(height_map, (place + vec2(origin_cell) + 0.5) * height_texel, 0.0).r;
}
#endif

float depth_in_surface(vec3 point) {
    return height_at(point.xy) - point.z;
}

float outward() {
    return 1.0;
}
#endif

// The current ray begins above the surface.
bool begins_above = false;

bool is_on_surface(vec2 place) {
#ifdef TILE
    return !is_off_tile((place + 0.5) * height_texel);
#else
    return all(greaterThanEqual(place, box_begin.xy)) && all(lessThanEqual(place, box_end.xy));
#endif
}
