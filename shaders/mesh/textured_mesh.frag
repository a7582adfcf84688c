#include "frame/frame_block.glsl"
#include "frame/air.glsl"
#include "material/surface_shader.glsl"
#include "relief/relief_surface.glsl"
#include "material/tile_surface.glsl"
#ifndef HIT
#include "frame/surface_light.glsl"
#include "material/tile_light.glsl"
#include "material/tile_lighting.glsl"
#ifdef MESH_SHADOWS
#include "mesh/sun_on_mesh.glsl"
#endif
#endif

#ifdef WARPED
// Visible tile coordinate, height and 1; zeros if nothing is visible.
layout(binding = warped_map_unit) uniform sampler2D warped_map;
uniform vec4 warp_from_tile; // texture coordinate = tile coordinate · xy + zw
#endif

#include "frame/output.glsl"

void main() {
    set_from_vertices();
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
    hit_low = vec2(0.0);
#else
    vec2 right = dFdx(FROM_PIXEL_TO_PIXEL(vertex_coordinate));
    vec2 up = dFdy(FROM_PIXEL_TO_PIXEL(vertex_coordinate));
    vec3 albedo = textureLod(color_map, coordinate, level_of(color_map, right, up)).rgb;
#ifdef MESH_SHADOWS
    float sun = sun_on_mesh(relative, dFdx(FROM_PIXEL_TO_PIXEL(vertex_relative)),
                            dFdy(FROM_PIXEL_TO_PIXEL(vertex_relative)));
#else
    const float sun = 1.0;
#endif
    vec3 lit = lit_tile(albedo, coordinate, tangent_space(), right, up, sun);
    color = vec4(seen_through_air(shaded(lit, relative), length(relative)), 1.0);
#endif
}
