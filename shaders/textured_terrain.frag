// A terrain with a tile of detail that it is lit by.
#define GROUND
#include "frame_block.glsl"
#include "air.glsl"
#include "relief_surface.glsl"
#include "tile_surface.glsl"
#include "surface_light.glsl"
#include "tile_light.glsl"
#include "tile_looks.glsl"
#include "ground_color.glsl"

vec3 seen_in(mat3 space, vec3 albedo, vec2 right, vec2 up, float visibility, float height_share) {
    vec3 shown = tinted(albedo, tile_coordinate, right, up);
    return lit_tile(shown, tile_coordinate, space, right, up, visibility);
}
