// Relief search along the pixel's ray, in the tangent plane of the carrying surface.
#if defined(EXACT)
#include "relief/relief_exact_tile.glsl"
#elif defined(CONE)
#include "relief/relief_cone.glsl"
#elif defined(LAYERS)
#include "relief/relief_layers.glsl"
#elif defined(PARALLAX)
#include "relief/relief_parallax.glsl"
#else
#include "relief/relief_linear.glsl"
#endif

// Limit of the tiles that a flat ray crosses; nearer relief hides what lies beyond.
const float max_tiles = 64.0;
// Margin around the heights [0,1]: rays begin above and end below them despite rounding. Floats near 1
// have errors of 2^-24, and a ray adds a few of them.
const float margin = 1.0 / 4096.0;

// The ray in samples and height; `way_per_height`: share of the way to the eye per height of 1.
struct TileRay {
    vec3 start;
    vec3 span;
    float way_per_height;
};

// `to_eye`: tangent space. `near_part`: share of the way before the near plane.
TileRay ray_through(vec3 to_eye, float near_part) {
    vec2 samples = tile_samples();
    vec2 samples_per_metre = tiles_per_metre * samples;
    float way = metres_per_unit.z / max(to_eye.z, 1e-30);
    vec2 tiles = abs(to_eye.xy * way * tiles_per_metre);
    way *= min(1.0, max_tiles / max(max(tiles.x, tiles.y), 1e-30));
    vec2 shift = to_eye.xy * way * samples_per_metre;
    float top = 1.0 + margin;
    if (perspective > 0.5) {
        top = min(top, mesh_height + (1.0 - near_part) / way); // the eye may be near
    }
    vec2 coordinate = tile_coordinate;
#ifdef WRAP
    coordinate = fract(coordinate); // keeps precision
#endif
    vec2 entry = coordinate * samples - 0.5;
    vec3 start = vec3(entry + shift * (top - mesh_height), top);
    vec3 end = vec3(entry - shift * (margin + mesh_height), -margin);
    return TileRay(start, end - start, way);
}

// The part of a ray over the tile, from x to y; empty if x >= y.
vec2 part_on_tile(vec3 start, vec3 span) {
    if (bounded < 0.5) {
        return vec2(0.0, 1.0);
    }
    vec2 away = vec2(equal(span.xy, vec2(0.0)));
    vec2 inverse = (1.0 - away) / (span.xy + away);
    vec2 one = (vec2(-0.5) - start.xy) * inverse;
    vec2 other = (tile_samples() - 0.5 - start.xy) * inverse;
    vec2 enter = min(one, other) - away;
    vec2 leave = max(one, other) + 2.0 * away;
    float begin = max(max(enter.x, enter.y), 0.0);
    float end = min(min(leave.x, leave.y), 1.0);
    vec2 middle = start.xy + 0.5 * (begin + end) * span.xy;
    bool inside = all(greaterThanEqual(middle, vec2(-0.5))) &&
                  all(lessThanEqual(middle, tile_samples() - 0.5));
    return inside ? vec2(begin, end) : vec2(1.0, 0.0);
}
