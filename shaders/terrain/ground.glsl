// A tile of detail that repeats over a terrain. It is looked at along one of the local axes, the one
// that the surface faces most, in the plane that touches the surface there.
in vec2 tile_place;     // samples from the terrain tile's first
in vec3 local_from_eye; // metres

uniform mat3 world_from_local; // directions
uniform vec3 tiles_at_eye;     // from the local origin, along each axis, less whole ones

vec3 from_eye = vec3(0.0); // local metres
vec3 relative = vec3(0.0); // from the eye, metres
vec2 tile_coordinate = vec2(0.0);
vec2 tiles_per_metre = vec2(1.0);

// How far along a local axis u and v go, as columns. Pictures on walls stand upright, and are not
// mirrored.
mat2x3 directions_along(int axis, vec3 normal) {
    if (axis == 0) {
        return mat2x3(vec3(0.0, normal.x < 0.0 ? -1.0 : 1.0, 0.0), vec3(0.0, 0.0, -1.0));
    }
    if (axis == 1) {
        return mat2x3(vec3(normal.y < 0.0 ? 1.0 : -1.0, 0.0, 0.0), vec3(0.0, 0.0, -1.0));
    }
    return mat2x3(vec3(1.0, 0.0, 0.0), vec3(0.0, -1.0, 0.0));
}

// Local directions: how u and v grow within the plane that touches the surface, and the normal. Such
// a frame gives a way's part in the plane, along u and along v, and off it by a product from the
// left, and by one from the right the normal of what rises so far along them. On a slope u and v grow
// less than 1 a metre: the heightfield's own frame, with its gradient in it (Blinn 1978).
mat3 space_along(mat2x3 directions, vec3 normal) {
    return mat3(directions[0] - normal * dot(normal, directions[0]),
                directions[1] - normal * dot(normal, directions[1]), normal);
}

// What each axis gives to what is seen; more than one only where the surface faces several alike.
vec3 shares_of_axes(vec3 normal) {
    const float blended = 0.15;
    vec3 facing = abs(normal);
    float most = max(max(facing.x, facing.y), facing.z);
    vec3 shares = max(facing - (most - blended), vec3(0.0));
    return shares / (shares.x + shares.y + shares.z);
}

int max_faced_axis(vec3 shares) {
    if (shares.z >= max(shares.x, shares.y)) {
        return 2;
    }
    return shares.x >= shares.y ? 0 : 1;
}
