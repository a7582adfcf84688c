// A terrain with a relief search per pixel.
#define GROUND
#define TILE
#define WRAP
#define PER_SAMPLE
#include "frame/frame_block.glsl"
#include "frame/air.glsl"
#include "material/surface_shader.glsl"
#include "relief/relief_surface.glsl"
#include "material/tile_surface.glsl"
#include "material/tile_search.glsl"
#include "material/tile_light.glsl"
#include "material/tile_shadow.glsl"
#include "terrain/ground_color.glsl"

// Moves `place` to the hit, if any.
void move_to_hit(mat3 space, vec3 way, inout vec2 place) {
    float near_part = near_depth / max(dot(relative, view_forward.xyz), near_depth);
    TileRay ray = ray_through((local_from_relative * way) * space, near_part);
    float part;
    vec2 met;
    if (find_hit(ray.start, ray.span, part, met)) {
        place = met;
    }
}

vec3 seen_in(mat3 space, vec3 albedo, vec2 right, vec2 up, float visibility, float height_share) {
    vec3 way = way_to_eye();
    vec2 place = fract(tile_coordinate) * tile_samples() - 0.5;
    float sun = visibility;
    if (height_share > 0.0) {
        metres_per_unit = vec3(1.0 / (tiles_per_metre * tile_samples()), lift * height_share);
        move_to_hit(space, way, place);
        sun *= sun_share(place, space, right, up);
    }
    vec2 coordinate = (place + 0.5) * height_texel;
    vec3 shown = tinted(albedo, coordinate, right, up);
    vec3 leaning = mapped_normal(coordinate, level_of(normal_map, right, up));
    vec3 normal = world_normal_of(leaning, space);
    vec3 upright = world_normal_of(vec3(0.0, 0.0, 1.0), space);
    return shiny_color(shown, normal, upright, normalize(way), sun);
}
