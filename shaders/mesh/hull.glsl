// A tile of detail in a hull around a mesh, as a fragment on the far side of one of the hull's
// tetrahedra sees it. Over a tetrahedron texture coordinates and height are linear, so that a ray is
// straight in them, too (Hirche, Ehlert, Guthe and Doggett 2004).
in vec3 vertex_relative;
in vec4 vertex_shares;
flat in mat3 shares_of_way;  // columns: what a local metre along x, y, z adds to those of corners 1 to 3
flat in mat4x2 coordinates;  // of the corners
flat in vec4 heights;        // of the corners, 0 or 1 and a little beyond
flat in mat4x3 corner_normals;
flat in vec4 parted; // 1 where beyond the side across from a corner normals are others

vec3 relative = INSIDE(vertex_relative); // from the eye, metres
vec4 shares = INSIDE(vertex_shares);     // of the corners in this place: they add up to 1

uniform vec4 coordinate_range; // of the texture where the hull is lowest: least and greatest

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

// Whether a ray, on the way of which a place of the surface lies, came through the mesh from behind,
// where nothing is seen of it: it rises there, and, the mesh bent as its normals say, before it rose
// from beneath the lowest height over the mesh. Over an outline or an edge it comes from above, or
// from beside. `local_way` to the eye, `toward` as shares.
bool came_from_behind(vec4 at, vec3 local_way, vec4 toward) {
    float rise = -dot(normalize(corner_normals * at), local_way) / metres_per_unit.z;
    float bend = dot(local_way, corner_normals * toward) / metres_per_unit.z;
    float height = dot(heights, at);
    float within = rise * rise - 2.0 * bend * height;
    if (rise <= 0.0 || within <= 0.0) {
        return false;
    }
    vec2 beneath = coordinates * (at + 2.0 * height / (rise + sqrt(within)) * toward);
    return all(greaterThanEqual(beneath, coordinate_range.xy)) &&
           all(lessThanEqual(beneath, coordinate_range.zw));
}
