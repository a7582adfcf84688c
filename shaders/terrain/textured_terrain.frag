// A terrain lit with surface detail.
#define GROUND
#include "frame/frame_block.glsl"
#include "frame/air.glsl"
#include "material/surface_shader.glsl"
#include "relief/relief_surface.glsl"
#include "material/tile_surface.glsl"
#include "frame/surface_light.glsl"
#include "material/tile_light.glsl"
#include "material/tile_lighting.glsl"
#include "terrain/ground_color.glsl"

vec3 seen_in(mat3 space, vec3 albedo, vec2 right, vec2 up, float visibility, float height_share) {
    vec3 shown = tinted(albedo, tile_coordinate, right, up);
    return lit_tile(shown, tile_coordinate, space, right, up, visibility);
}
