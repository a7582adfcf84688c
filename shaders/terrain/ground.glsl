// Surface detail on a terrain, projected along the local axis that the surface faces most (triplanar), in
// the tangent plane.
#ifdef SLIVER
#include "terrain/sliver.glsl"
#else
in vec2 tile_place;     // samples from the terrain tile's first
in vec3 local_from_eye; // metres

uniform mat3 world_from_local; // directions
#endif
uniform vec3 tiles_at_eye;     // position of the eye modulo a tile

vec3 from_eye = vec3(0.0); // local metres
vec3 relative = vec3(0.0); // from the eye, metres
vec2 tile_coordinate = vec2(0.0);
vec2 tiles_per_metre = vec2(1.0);

// Local directions of u and v, as columns. Pictures on walls are upright and not mirrored.
mat2x3 directions_along(int axis, vec3 normal) {
    if (axis == 0) {
        return mat2x3(vec3(0.0, normal.x < 0.0 ? -1.0 : 1.0, 0.0), vec3(0.0, 0.0, -1.0));
    }
    if (axis == 1) {
        return mat2x3(vec3(normal.y < 0.0 ? 1.0 : -1.0, 0.0, 0.0), vec3(0.0, 0.0, -1.0));
    }
    return mat2x3(vec3(1.0, 0.0, 0.0), vec3(0.0, -1.0, 0.0));
}

// Local frame: gradients of u and v in the tangent plane, and the normal. direction * frame gives the
// components along u, v and the normal; frame * vec3(-slope, 1) gives a bumped normal. On slopes the
// gradients are shorter than 1 per metre (Blinn 1978).
mat3 space_along(mat2x3 directions, vec3 normal) {
    return mat3(directions[0] - normal * dot(normal, directions[0]),
                directions[1] - normal * dot(normal, directions[1]), normal);
}

// Weights of the axes; blends only where the surface faces several equally.
vec3 shares_of_axes(vec3 normal) {
    const float blended = 0.15;
    vec3 facing = abs(normal);
    float strongest = max(max(facing.x, facing.y), facing.z);
    vec3 shares = max(facing - (strongest - blended), vec3(0.0));
    return shares / (shares.x + shares.y + shares.z);
}

int max_faced_axis(vec3 shares) {
    if (shares.z >= max(shares.x, shares.y)) {
        return 2;
    }
    return shares.x >= shares.y ? 0 : 1;
}
