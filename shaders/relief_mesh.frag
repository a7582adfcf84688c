// Each pixel looks for the tile's surface along its ray, in the plane that touches the mesh there.
#define TILE
#include "frame_block.glsl"
#include "air.glsl"
#include "relief_surface.glsl"
#include "tile_surface.glsl"
#if defined(EXACT)
#include "relief_exact_tile.glsl"
#elif defined(CONE)
#include "relief_cone.glsl"
#elif defined(LAYERS)
#include "relief_layers.glsl"
#elif defined(PARALLAX)
#include "relief_parallax.glsl"
#else
#include "relief_linear.glsl"
#endif
#ifdef FADE
#include "relief_fade.glsl"
#endif
#ifndef HIT
#include "tile_light.glsl"
#if defined(HARD_SHADOW) || defined(SOFT_SHADOW)
#define SHADOW
#include "relief_shadow.glsl"
#endif
#ifdef SMOOTH_EDGES
#include "relief_edges.glsl"
#endif
#endif

uniform float mesh_height; // of the tile's heights in [0,1]: where the mesh lies
uniform float near_depth;  // metres, in perspective

#ifdef HIT
layout(location = 0) out vec4 hit; // col, row, height, depth
#else
layout(location = 0) out vec4 color;
#endif

// A ray that is so flat that it would cross more tiles than these on its way through the heights is
// taken to cross no more: what it looks for is hidden by what stands before it.
const float most_tiles = 64.0;
// How far the search goes beyond the heights [0,1], so that a ray begins above and ends below them
// whatever rounding says: floats near 1 are good to 2^-24, and a ray adds a few of them.
const float margin = 1.0 / 4096.0;

// The ray through the heights, in samples and height, and how far along the way to the eye a
// height of 1 is.
struct TileRay {
    vec3 start;
    vec3 span;
    float way_per_height;
};

// `to_eye` in tangent space; `near_part` of the way is not seen.
TileRay ray_through(vec3 to_eye, float near_part) {
    vec2 samples = tile_samples();
    vec2 samples_per_metre = tiles_per_metre * samples;
    float way = lift / max(to_eye.z, 1e-30);
    vec2 tiles = abs(to_eye.xy * way * tiles_per_metre);
    way *= min(1.0, most_tiles / max(max(tiles.x, tiles.y), 1e-30));
    vec2 shift = to_eye.xy * way * samples_per_metre;
    float top = 1.0 + margin;
    if (perspective > 0.5) {
        top = min(top, mesh_height + (1.0 - near_part) / way); // the eye may be that near
    }
    vec2 coordinate = tile_coordinate;
#ifdef WRAP
    coordinate = fract(coordinate); // small numbers are exact ones
#endif
    vec2 entry = coordinate * samples - 0.5;
    vec3 start = vec3(entry + shift * (top - mesh_height), top);
    vec3 end = vec3(entry - shift * (margin + mesh_height), -margin);
    return TileRay(start, end - start, way);
}

// Cuts off what is beyond the tile; false where nothing is left.
bool cut_to_tile(inout TileRay ray) {
    if (bounded < 0.5) {
        return true;
    }
    vec2 away = vec2(equal(ray.span.xy, vec2(0.0)));
    vec2 inverse = (1.0 - away) / (ray.span.xy + away);
    vec2 one = (vec2(-0.5) - ray.start.xy) * inverse;
    vec2 other = (tile_samples() - 0.5 - ray.start.xy) * inverse;
    vec2 enter = min(one, other) - away;
    vec2 leave = max(one, other) + 2.0 * away;
    float begin = max(max(enter.x, enter.y), 0.0);
    float end = min(min(leave.x, leave.y), 1.0);
    vec2 middle = ray.start.xy + 0.5 * (begin + end) * ray.span.xy;
    bool inside = all(greaterThanEqual(middle, vec2(-0.5))) &&
                  all(lessThanEqual(middle, tile_samples() - 0.5));
    ray.start += begin * ray.span;
    ray.span *= end - begin;
    return begin < end && inside;
}

#ifndef HIT
// Share of the sun's light that reaches a place of the surface, past the surface.
float sun_share(vec2 place, mat3 space) {
#ifdef SHADOW
    vec3 direction = (local_from_relative * to_sun.xyz) * space / metres_per_unit;
    vec2 reach = most_tiles * tile_samples();
    vec2 low = mix(place - reach, vec2(-0.5), bounded);
    vec2 high = mix(place + reach, tile_samples() - 0.5, bounded);
    return sun_at(place, direction, vec3(low, -margin), vec3(high, 1.0 + margin));
#else
    return 1.0;
#endif
}

// What a place of the tile sends to an eye that is `way` off. `right`, `up`: what a pixel to the
// right and one up add to the tile's coordinate.
vec3 color_at(vec2 place, mat3 space, vec3 way, vec2 right, vec2 up) {
    vec2 coordinate = (place + 0.5) * height_texel;
    vec3 albedo = textureLod(color_map, coordinate, level_of(color_map, right, up)).rgb;
    vec3 leaning = mapped_normal(coordinate, level_of(normal_map, right, up));
    vec3 normal = world_normal_of(leaning, space);
#ifdef LAYERS
    vec3 upright = normal; // its own back is lit, too
#else
    vec3 upright = world_normal_of(vec3(0.0, 0.0, 1.0), space);
#endif
    return shiny_color(albedo, normal, upright, normalize(way), sun_share(place, space));
}
#endif

void main() {
    mat3 space = tangent_space();
    vec3 way = way_to_eye();
    metres_per_unit = vec3(1.0 / max(tiles_per_metre * tile_samples(), vec2(1e-30)), lift);
    float near_part = near_depth / max(dot(relative, view_forward.xyz), near_depth);
    TileRay ray = ray_through((local_from_relative * way) * space, near_part);
    vec2 right = dFdx(tile_coordinate);
    vec2 up = dFdy(tile_coordinate);
    bool inside = cut_to_tile(ray);
    vec3 start = ray.start;
    vec3 span = ray.span;
#ifdef FADE
    vec2 ends = stretch(-margin, 1.0 + margin, start, span);
#endif
    float part;
    vec2 place;
    if (!inside || !find_hit(start, span, part, place)) {
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
#else
    vec3 shown = color_at(place, space, way, right, up);
#ifdef SMOOTH_EDGES
    vec2 missed;
    float distance_share = near_miss(start, span, part, missed);
    if (distance_share < 1.0) {
        shown = mix(color_at(missed, space, way, right, up), shown, distance_share);
    }
#endif
    color = vec4(seen_through_air(shown, length(where)), 1.0);
#endif
}
