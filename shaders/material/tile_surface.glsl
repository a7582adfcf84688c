// Surface detail at a fragment of a mesh. Tangent space, metres: x along u, y along v, z off the visible
// side. From behind heights are 1 - height.
#include "frame/detail_block.glsl"
#include "frame/fragment.glsl"
#ifdef GROUND
#include "terrain/ground.glsl"
#elif defined(HULL)
#include "mesh/hull.glsl"
#else
in vec3 vertex_relative;
in vec3 vertex_normal;
in vec4 vertex_tangent;
in vec2 vertex_coordinate;
in vec2 vertex_tiles_per_metre;

vec3 relative = vec3(0.0); // from the eye, metres
vec3 local_normal = vec3(0.0);
vec4 local_tangent = vec4(0.0); // w: handedness
vec2 tile_coordinate = vec2(0.0);
vec2 tiles_per_metre = vec2(0.0); // along x and y

// NVIDIA's compiler knows no interpolateAtCentroid outside of functions.
void set_from_vertices() {
    relative = INSIDE(vertex_relative);
    local_normal = INSIDE(vertex_normal);
    local_tangent = INSIDE(vertex_tangent);
    tile_coordinate = INSIDE(vertex_coordinate);
    tiles_per_metre = INSIDE(vertex_tiles_per_metre);
}
#endif

uniform mat3 local_from_relative; // directions

#if !defined(GROUND) && !defined(HULL)
// Local directions from tangent space, orthonormal.
mat3 tangent_space() {
    vec3 z = normalize(local_normal);
    vec3 x = normalize(local_tangent.xyz - z * dot(z, local_tangent.xyz));
    return mat3(x, local_tangent.w * cross(z, x), side * z);
}
#endif

// World direction towards the eye; in perspective its length is the distance.
vec3 way_to_eye() {
    return mix(-view_forward.xyz, -relative, perspective);
}

vec2 tile_samples() {
    return vec2(textureSize(height_map, 0));
}

bool is_off_tile(vec2 coordinate) {
    return bounded > 0.5 && (any(lessThan(coordinate, vec2(0.0))) ||
                             any(greaterThan(coordinate, vec2(1.0))));
}

#ifdef HIT
// Column and row in the tile, its height there in [0,1], metres along the view axis.
vec4 tile_hit(vec2 place, vec3 where) {
    vec2 samples = tile_samples();
    vec2 wrapped = mod(place + 0.5, samples) - 0.5;
#ifndef WRAP
    wrapped = clamp(place, vec2(-0.5), samples - 0.5);
#endif
    float height = 0.5 + side * (height_at(place) - 0.5);
    return vec4(wrapped, height, dot(where, view_forward.xyz));
}
#endif
