#include "frame/frame_block.glsl"
#include "frame/air.glsl"
#include "material/surface_shader.glsl"
#include "frame/fragment.glsl"
#include "frame/count.glsl"
#ifdef SLIVER
#include "terrain/sliver.glsl"
#else
#include "frame/distance.glsl"

in vec2 tile_place;
#ifdef HIT
in vec2 place_from_eye;
in vec2 height_and_depth;

uniform vec4 eye_sample; // xy: col, row; zw: to be added
#endif
#endif

uniform vec2 tile_sample;     // col, row of the tile's first sample
uniform vec4 lit_from_sample; // texture coordinate = sample · xy + zw

layout(binding = lit_map_unit) uniform sampler2D lit_map; // reflected light, linear
#ifdef POINT_LIGHTS
#include "terrain/ground_points.glsl"
#endif
#ifdef MESH_SHADOWS
#include "terrain/ground_sun.glsl"
layout(binding = sun_map_unit) uniform sampler2D sun_map; // the sun's part; lit_map has the rest
#endif
#ifdef OVERLAY
#include "terrain/overlay.glsl"
#ifndef SLIVER
in float ground_height; // true metres
#endif
#endif
#ifdef WARPED
// Visible column, row (< 0: none) and height per sample.
layout(binding = warped_places_unit) uniform sampler2D warped_places;
#endif

#include "frame/output.glsl"

#if defined(HIT) && !defined(WARPED)
// A place as two floats, in xy and zw, moved by `offset` (Knuth's two-sum).
vec4 moved(vec4 place, vec2 offset) {
    precise vec2 sum = place.xy + offset;
    precise vec2 added = sum - place.xy;
    precise vec2 low = ((place.xy - (sum - added)) + (offset - added)) + place.zw;
    precise vec2 high = sum + low;
    precise vec2 rest = low - (high - sum);
    return vec4(high, rest);
}

#ifdef SLIVER
void write_hit() {
    vec4 place = moved(moved(vec4(tile_sample, 0.0, 0.0), corner_place), from_corner);
    hit = vec4(place.xy, true_height, dot(way_from_eye, view_forward.xyz));
    hit_low = place.zw;
}
#else
void write_hit() {
    // Floats round places by a share of their distance from the origin, which walls show as their height.
    bool is_near_eye = dot(place_from_eye, place_from_eye) < dot(tile_place, tile_place);
    vec4 place = is_near_eye ? moved(eye_sample, place_from_eye)
                             : moved(vec4(tile_sample, 0.0, 0.0), tile_place);
    hit = vec4(place.xy, height_and_depth);
    hit_low = place.zw;
}
#endif
#endif

#if !defined(HIT) && !defined(WARPED)
// Of the place per pixel, as columns.
mat2 change_of_place() {
#ifdef SLIVER
    return place_per_pixel;
#else
    return mat2(dFdx(tile_place), dFdy(tile_place));
#endif
}

vec3 looked_up(sampler2D map, vec2 place) {
    vec2 coordinate = place * lit_from_sample.xy + lit_from_sample.zw;
#if defined(SLIVER) || defined(MULTISAMPLED)
    mat2 change = change_of_place();
    return textureGrad(map, coordinate, change[0] * lit_from_sample.xy, change[1] * lit_from_sample.xy).rgb;
#else
    return texture(map, coordinate).rgb;
#endif
}

#ifdef POINT_LIGHTS
vec3 from_points_at(vec2 place) {
    return reflected_from_points(looked_up(lit_albedo, place), looked_up(lit_normals, place), INSIDE(way_from_eye));
}
#endif
#endif

void main() {
#ifdef SLIVER
    set_from_corners();
#endif
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
    write_hit();
#elif defined(WARPED)
    vec3 lit =
        textureGrad(lit_map, place * lit_from_sample.xy + lit_from_sample.zw, across, down).rgb;
#else
    vec3 lit = looked_up(lit_map, place);
#endif
#ifdef MESH_SHADOWS
    lit += sun_on_triangles(place, INSIDE(way_from_eye), change_of_place()) * looked_up(sun_map, place);
#endif
#ifdef POINT_LIGHTS
    vec3 from_points = from_points_at(place);
#ifdef OVERLAY
    light_under_overlay = from_points;
#else
    lit += from_points;
#endif
#endif
#if defined(OVERLAY) && defined(SLIVER)
    vec3 perpendicular = cross(world_from_local * local_per_pixel[0], world_from_local * local_per_pixel[1]);
    lit = overlaid(lit, ground_place(way_from_eye, along_turned_axes(perpendicular)), place, true_height,
                   !is_level(true_height, max(abs(dFdx(true_height)), abs(dFdy(true_height)))));
#elif defined(OVERLAY)
    vec3 perpendicular =
        cross(dFdx(FROM_PIXEL_TO_PIXEL(way_from_eye)), dFdy(FROM_PIXEL_TO_PIXEL(way_from_eye)));
    float height = INSIDE(ground_height);
    float change = max(abs(dFdx(FROM_PIXEL_TO_PIXEL(ground_height))), abs(dFdy(FROM_PIXEL_TO_PIXEL(ground_height))));
    lit = overlaid(lit, ground_place(INSIDE(way_from_eye), along_turned_axes(perpendicular)), place, height,
                   !is_level(height, change));
#endif
#ifndef HIT
    color = vec4(seen_through_air(shaded(lit, INSIDE(way_from_eye)), distance_to_eye()), 1.0);
#endif
#ifdef COUNT
#ifdef WARPED
    count_taps(1.0);
#endif
    count_taps(1.0);
    work = vec4(work_taps, work_steps, work_rays, 1.0);
#endif
}
