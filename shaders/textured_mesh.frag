#include "frame_block.glsl"
#include "air.glsl"
#include "relief_surface.glsl"
#include "tile_surface.glsl"
#ifndef HIT
#include "surface_light.glsl"
#include "tile_light.glsl"
#endif

#ifdef WARPED
// What is seen at a sample of the mesh: the tile's coordinate, its height, 1; all 0 where nothing is.
layout(binding = 6) uniform sampler2D warped_map;
uniform vec4 warp_from_tile; // texture coordinate = tile coordinate · xy + zw
#endif

#ifdef HIT
layout(location = 0) out vec4 hit; // col, row, height, depth
#else
layout(location = 0) out vec4 color;
#endif

#ifndef HIT
// How much higher the tile is here than a little way towards the sun: the slope that faces it
// (emboss bump mapping; Schlag 1994). As a part of the sun's light.
float embossed(vec2 place, float level, mat3 space) {
    vec3 to_light = normalize(local_from_relative * to_sun.xyz) * space;
    vec2 samples_per_metre = tiles_per_metre * tile_samples();
    float metres = max(search_values.x, exp2(level)) / max(samples_per_metre.x, 1e-30);
    float below = seen_height(place + to_light.xy * metres * samples_per_metre, level);
    return (seen_height(place, level) - below) * lift / metres;
}

// `right`, `up`: what a pixel to the right and one up add to the tile's coordinate.
vec3 lit_tile(vec3 albedo, vec2 coordinate, vec2 right, vec2 up) {
    vec2 place = coordinate * tile_samples() - 0.5;
    mat3 space = tangent_space();
    vec3 upright = world_normal_of(vec3(0.0, 0.0, 1.0), space);
#if defined(NORMAL_MAP)
    float level = level_of(normal_map, right, up);
    vec3 normal = world_normal_of(mapped_normal(coordinate, level), space);
    return shiny_color(albedo, normal, upright, normalize(way_to_eye()), 1.0);
#elif defined(BUMP)
    float level = max(level_of(height_map, right, up), 0.0);
    vec3 normal = world_normal_of(bumped_normal(place, level), space);
    return shiny_color(albedo, normal, upright, normalize(way_to_eye()), 1.0);
#elif defined(EMBOSS)
    float facing = clamp(8.0 * dot(upright, to_sun.xyz), 0.0, 1.0);
    float level = max(level_of(height_map, right, up), 0.0);
    float sun = max(dot(upright, to_sun.xyz) + embossed(place, level, space), 0.0) * facing;
    return albedo * (sun_color.rgb * sun + ambient_color.rgb * (0.5 + 0.5 * upright.z));
#else
    return lit_color(albedo, upright, 1.0);
#endif
}
#endif

void main() {
    if (is_off_tile(tile_coordinate)) {
        discard;
    }
    vec2 coordinate = tile_coordinate;
#ifdef WARPED
    vec2 on_map = coordinate * warp_from_tile.xy + warp_from_tile.zw;
    vec2 samples = vec2(textureSize(warped_map, 0));
    vec2 middle = (floor(on_map * samples) + 0.5) / samples; // of the nearest sample
    vec4 seen = textureLod(warped_map, middle, 0.0);
    if (seen.w < 1.0) {
        discard;
    }
    coordinate = seen.xy + (on_map - middle) / warp_from_tile.xy;
#endif
#ifdef HIT
    hit = tile_hit(coordinate * tile_samples() - 0.5, relative);
#else
    vec2 right = dFdx(tile_coordinate);
    vec2 up = dFdy(tile_coordinate);
    vec3 albedo = textureLod(color_map, coordinate, level_of(color_map, right, up)).rgb;
    vec3 lit = lit_tile(albedo, coordinate, right, up);
    color = vec4(seen_through_air(lit, length(relative)), 1.0);
#endif
}
