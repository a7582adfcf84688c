// Surface detail in a hull around a mesh, at a fragment of a tetrahedron's back face. Texture coordinates
// and height are linear in a tetrahedron, so rays stay straight in them (Hirche, Ehlert, Guthe and Doggett
// 2004). Shares are barycentric coordinates.
in vec3 vertex_relative;
in vec4 vertex_shares;
flat in mat3 shares_of_way;  // columns: change of the shares of corners 1 to 3 per local metre along x, y, z
flat in mat4x2 coordinates;  // of the corners
flat in vec4 heights;        // of the corners: 0 or 1 with a margin
flat in mat4x3 corner_normals;
flat in vec4 hard_edges; // 1: the side opposite the corner lies on a hard edge

vec3 relative = INSIDE(vertex_relative); // from the eye, metres
vec4 shares = INSIDE(vertex_shares);     // of the corners; their sum is 1

uniform vec4 coordinate_range; // texture coordinates at the bottom of the hull: minimum, maximum

vec2 tile_coordinate = vec2(0.0);
vec2 tiles_per_metre = vec2(1.0); // contained in the frame

vec4 shares_along(vec3 local_way) {
    vec3 more = shares_of_way * local_way;
    return vec4(-(more.x + more.y + more.z), more);
}

// Gradients of the tile coordinate per local metre: u and v as columns.
mat2x3 coordinate_slopes() {
    mat3x2 from_first = mat3x2(coordinates[1] - coordinates[0], coordinates[2] - coordinates[0],
                               coordinates[3] - coordinates[0]);
    mat3x2 slopes = from_first * shares_of_way;
    return transpose(mat3x2(slopes[0] * repeats, slopes[1] * repeats, slopes[2] * repeats));
}

// Local frame: gradients of u and v in the tangent plane, and the normal.
mat3 space_at(vec4 at) {
    vec3 normal = normalize(corner_normals * at);
    mat2x3 slopes = coordinate_slopes();
    return mat3(slopes[0] - normal * dot(normal, slopes[0]),
                slopes[1] - normal * dot(normal, slopes[1]), normal);
}

// Whether the ray to a hit came through the mesh from behind, which makes the hit invisible: it rises at the
// hit, and before that it rose from below the lowest height over the mesh, curved as its normals. At
// outlines and edges rays come from above or from the side. `local_way`: to the eye; `toward`: as shares.
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
