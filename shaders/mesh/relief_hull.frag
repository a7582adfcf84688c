// Relief search along the pixel's ray in a hull: the mesh moved inwards to the lowest and outwards to the
// highest height.
#define TILE
#define HULL
#define PER_SAMPLE
#include "frame/frame_block.glsl"
#include "frame/air.glsl"
#include "material/surface_shader.glsl"
#include "relief/relief_surface.glsl"
#include "material/tile_surface.glsl"
#include "material/tile_search.glsl"
#ifndef HIT
#include "material/tile_light.glsl"
#include "material/tile_shadow.glsl"
#include "material/tile_color.glsl"
#endif

#include "frame/output.glsl"

// Margin of the search around a tetrahedron, in shares: closes gaps from rounding and from the rasterizers'
// vertex grid of 1/256 pixel.
float share_beyond() {
    vec4 a_pixel = fwidth(shares);
    float widest = max(max(a_pixel.x, a_pixel.y), max(a_pixel.z, a_pixel.w));
    return max(1.5 / 256.0 * widest, 1.0 / 16384.0);
}

// The part of a way inside the tetrahedron; `across`: the corner opposite the side of its end. `toward`:
// change of the shares along the way.
float way_inside(vec4 toward, float beyond, out int across) {
    float inside = 3e38;
    across = 0;
    for (int i = 0; i < 4; ++i) {
        float way = toward[i] < 0.0 ? (max(shares[i], 0.0) + beyond) / -toward[i] : 3e38;
        across = way < inside ? i : across;
        inside = min(inside, way);
    }
    return inside;
}

// In samples and height.
vec3 in_tile(vec4 at, vec2 first_tile) {
    vec2 coordinate = coordinates * at * repeats - first_tile;
    return vec3(coordinate * tile_samples() - 0.5, dot(heights, at));
}

// Change of the tile coordinate to a neighbouring pixel, in the mesh's tangent plane at the hit. `beside`:
// offset of the neighbour's fragment; `nearer`: share of the way to the fragment at the hit.
vec2 pixel_on_mesh(vec3 beside, vec4 at, float nearer) {
    vec3 normal = normalize(corner_normals * at);
    vec3 ray = local_from_relative * mix(view_forward.xyz, relative + beside, perspective);
    vec3 shift = local_from_relative * beside * mix(1.0, nearer, perspective);
    float facing = dot(normal, ray);
    float min_facing = 0.125 * length(ray); // relief at an outline faces the eye more
    facing = facing < 0.0 ? min(facing, -min_facing) : max(facing, min_facing);
    return coordinates * shares_along(shift - ray * (dot(normal, shift) / facing)) * repeats;
}

void main() {
    vec3 way = way_to_eye();
    vec3 local_way = local_from_relative * way;
    vec4 toward = shares_along(local_way);
    float near_part = near_depth / max(dot(relative, view_forward.xyz), near_depth);
    float beyond = share_beyond();
    int across;
    float more = way_inside(-toward, beyond, across);
    float first = way_inside(toward, beyond, across);
    bool from_face = hard_edges[across] > 0.5; // from another face over a hard edge
    if (perspective > 0.5 && first > 1.0 - near_part) {
        first = 1.0 - near_part;
        from_face = false;
    }
    tile_coordinate = coordinates * shares * repeats;
    vec3 beside = dFdx(relative);
    vec3 above = dFdy(relative);
#ifdef WRAP
    vec2 first_tile = floor(tile_coordinate);
#else
    vec2 first_tile = vec2(0.0);
#endif
    mat3 space = space_at(shares);
    vec2 samples_per_metre = vec2(length(space[0]), length(space[1])) * tile_samples();
    metres_per_unit = vec3(1.0 / max(samples_per_metre, vec2(1e-30)), lift);
    vec3 start = in_tile(shares + first * toward, first_tile);
    vec3 end = in_tile(shares - more * toward, first_tile);
    vec3 span = end - start;
    vec2 kept = part_on_tile(start, span);
    float part;
    vec2 place;
    if (kept.x >= kept.y) {
        discard;
    }
    if (from_face && kept.x <= 0.0 && depth_in_surface(start) > 0.0) {
        part = 0.0; // a wall between the faces' different heights
        place = start.xy;
    } else if (!find_hit(start + kept.x * span, (kept.y - kept.x) * span, part, place)) {
        discard;
    }
    float along = mix(first, -more, mix(kept.x, kept.y, part));
    vec4 at = shares + along * toward;
    if (came_from_behind(at, local_way, toward)) {
        discard;
    }
    vec3 where = relative + way * along;
    vec4 clip = clip_from_relative * vec4(where, 1.0);
    gl_FragDepth = clip.z / clip.w;
#ifdef HIT
    hit = tile_hit(place, where);
    hit_low = vec2(0.0);
#else
    vec2 right = pixel_on_mesh(beside, at, 1.0 - along);
    vec2 up = pixel_on_mesh(above, at, 1.0 - along);
    vec3 lit = color_at(place, space, way, right, up);
    color = vec4(seen_through_air(shaded(lit, where), length(where)), 1.0);
#endif
}
