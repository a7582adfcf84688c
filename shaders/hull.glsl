// A tile of detail in a hull around a mesh, as a fragment on the far side of one of the hull's
// tetrahedra sees it. Over a tetrahedron texture coordinates and height are linear, so that a ray is
// straight in them, too (Hirche, Ehlert, Guthe and Doggett 2004).
in vec3 relative; // from the eye, metres
in vec4 shares;   // of the corners in this place: they add up to 1
flat in mat3 shares_of_way;  // columns: what a local metre along x, y, z adds to those of corners 1 to 3
flat in mat4x2 coordinates;  // of the corners
flat in vec4 heights;        // of the corners, 0 or 1 and a little beyond
flat in mat4x3 corner_normals;

uniform vec2 repeats; // tiles along texture coordinates 0 to 1

vec2 tile_coordinate = vec2(0.0);
vec2 tiles_per_metre = vec2(1.0); // it is in the frame

vec4 shares_along(vec3 local_way) {
    vec3 more = shares_of_way * local_way;
    return vec4(-(more.x + more.y + more.z), more);
}

// What a local metre adds to the tile's coordinate: along u and v, as columns.
mat2x3 coordinate_slopes() {
    mat3x2 from_first = mat3x2(coordinates[1] - coordinates[0], coordinates[2] - coordinates[0],
                               coordinates[3] - coordinates[0]);
    mat3x2 slopes = from_first * shares_of_way;
    return transpose(mat3x2(slopes[0] * repeats, slopes[1] * repeats, slopes[2] * repeats));
}

// Local directions: how u and v grow within the plane that touches the mesh, and the normal.
mat3 space_at(vec4 at) {
    vec3 normal = normalize(corner_normals * at);
    mat2x3 slopes = coordinate_slopes();
    return mat3(slopes[0] - normal * dot(normal, slopes[0]),
                slopes[1] - normal * dot(normal, slopes[1]), normal);
}
