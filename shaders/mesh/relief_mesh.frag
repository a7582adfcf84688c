// Relief search along the pixel's ray in the mesh's tangent plane.
#define TILE
#define PER_SAMPLE
#include "frame/frame_block.glsl"
#include "frame/air.glsl"
#include "material/surface_shader.glsl"
#include "relief/relief_surface.glsl"
#include "material/tile_surface.glsl"
#include "material/tile_search.glsl"
#ifdef FADE
#include "relief/relief_fade.glsl"
#endif
#ifndef HIT
#include "material/tile_light.glsl"
#include "material/tile_shadow.glsl"
#include "material/tile_color.glsl"
#ifdef SMOOTH_EDGES
#include "relief/relief_edges.glsl"
#endif
#ifdef MESH_SHADOWS
#include "mesh/sun_on_mesh.glsl"
#endif
#endif

#include "frame/output.glsl"

void main() {
    set_from_vertices();
    mat3 space = tangent_space();
    vec3 way = way_to_eye();
    metres_per_unit = vec3(1.0 / max(tiles_per_metre * tile_samples(), vec2(1e-30)), lift);
    float near_part = near_depth / max(dot(relative, view_forward.xyz), near_depth);
    TileRay ray = ray_through((local_from_relative * way) * space, near_part);
    vec2 right = dFdx(tile_coordinate);
    vec2 up = dFdy(tile_coordinate);
#ifdef MESH_SHADOWS
    sun_beside_others = sun_on_mesh(relative, dFdx(relative), dFdy(relative)); // on the mesh below the relief
#endif
    vec2 kept = part_on_tile(ray.start, ray.span);
    ray.start += kept.x * ray.span;
    ray.span *= kept.y - kept.x;
    vec3 start = ray.start;
    vec3 span = ray.span;
#ifdef FADE
    vec2 ends = stretch(-margin, 1.0 + margin, start, span);
#endif
    float part;
    vec2 place;
    if (kept.x >= kept.y || !find_hit(start, span, part, place)) {
        discard;
    }
#ifdef FADE
    float met = mix(ends.x, ends.y, part);
#else
    float met = part;
#endif
    float height = ray.start.z + met * ray.span.z;
    vec3 where = relative + way * ((height - mesh_height) * ray.way_per_height);
#ifdef WRITE_DEPTH
    vec4 clip = clip_from_relative * vec4(where, 1.0);
    gl_FragDepth = clip.z / clip.w;
#endif
#ifdef HIT
    hit = tile_hit(place, where);
    hit_low = vec2(0.0);
#else
    vec3 shown = color_at(place, space, way, right, up);
#ifdef SMOOTH_EDGES
    vec2 missed;
    float at;
    float distance_share = near_miss(start, part * span, at, missed);
    if (distance_share < 1.0) {
        shown = mix(color_at(missed, space, way, right, up), shown, distance_share);
    }
#endif
    color = vec4(seen_through_air(shaded(shown, where), length(where)), 1.0);
#endif
}
