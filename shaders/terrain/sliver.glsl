// In slivers (view::SliverView) rasterizers interpolate wrongly, so values come from the corners.
layout(std430, binding = corners_binding) readonly buffer Corners {
    float corners[]; // view::GridVertex, three a triangle
};

uniform vec3 eye;      // local metres
uniform vec3 eye_rest; // local metres, to be added
uniform mat3 world_from_local;

struct Vertex {
    vec3 position; // local metres
    float height;  // true metres
    vec2 place;    // samples from the tile's first
    vec3 rest;     // local metres, to be added to the position
};

Vertex vertex_of(int corner) {
    int at = 9 * corner;
    return Vertex(vec3(corners[at], corners[at + 1], corners[at + 2]), corners[at + 3],
                  vec2(corners[at + 4], corners[at + 5]),
                  vec3(corners[at + 6], corners[at + 7], corners[at + 8]));
}

flat in int first_corner;

struct Corner {
    Vertex vertex;
    vec3 from_eye; // local metres
    vec4 clip;
    vec2 off; // from this fragment, as seen along its ray: pixels times w
};

// At this fragment, see set_from_corners().
vec3 local_from_eye = vec3(0.0); // metres
vec3 way_from_eye = vec3(0.0);   // metres
float true_height = 0.0;         // metres
vec2 corner_place = vec2(0.0);   // of a corner, samples from the tile's first
vec2 from_corner = vec2(0.0);    // samples
vec2 tile_place = vec2(0.0);     // samples from the tile's first
// Changes per pixel, along and across the triangle.
mat2 place_per_pixel = mat2(0.0);
mat2x3 local_per_pixel = mat2x3(0.0);

Corner corner_of(Vertex vertex) {
    precise vec3 from_eye = (vertex.position - eye) + (vertex.rest - eye_rest);
    vec4 clip = clip_from_relative * vec4(world_from_local * from_eye, 1.0);
    vec2 at = 2.0 * gl_FragCoord.xy * pixel_share.xy - 1.0;
    return Corner(vertex, from_eye, clip, 0.5 * (clip.xy - at * clip.w) / pixel_share.xy);
}

float cross_product(vec2 a, vec2 b) {
    return a.x * b.y - a.y * b.x;
}

float squared(vec2 v) {
    return dot(v, v);
}

const float tiny = 1e-30;

// Shares of three corners in the fragment, which is at 0. `a` to `b` is the longest edge. Along it the shares
// are exact; across it, where floats may not tell the corners apart, they are in the triangle.
vec3 shares_of(vec2 a, vec2 b, vec2 c) {
    vec2 edge = b - a;
    vec2 to_c = c - a;
    float length_squared = max(squared(edge), tiny);
    float part = clamp(-dot(a, edge) / length_squared, 0.0, 1.0);
    float part_of_c = clamp(dot(to_c, edge) / length_squared, 0.0, 1.0);
    float max_of_c = min(part / max(part_of_c, tiny), (1.0 - part) / max(1.0 - part_of_c, tiny));
    float across = cross_product(edge, to_c);
    float of_c = across == 0.0 ? 0.0 : clamp(cross_product(a, edge) / across, 0.0, min(max_of_c, 1.0));
    float of_b = part - of_c * part_of_c;
    return vec3(1.0 - of_c - of_b, of_b, of_c);
}

// `a` to `b` is the longest edge.
void set_between(Corner a, Corner b, Corner c) {
    vec3 shares = shares_of(a.off, b.off, c.off);
    local_from_eye = mat3(a.from_eye, b.from_eye, c.from_eye) * shares;
    way_from_eye = world_from_local * local_from_eye;
    true_height = dot(vec3(a.vertex.height, b.vertex.height, c.vertex.height), shares);
    vec2 to_b = b.vertex.place - a.vertex.place;
    vec2 to_c = c.vertex.place - a.vertex.place;
    corner_place = a.vertex.place;
    from_corner = shares.y * to_b + shares.z * to_c;
    tile_place = corner_place + from_corner;
    vec4 clip = shares.x * a.clip + shares.y * b.clip + shares.z * c.clip;
#ifdef CORNER_DEPTH
    gl_FragDepth = clip.z / clip.w;
#endif
    vec2 edge = b.off - a.off;
    float length_squared = max(squared(edge), tiny);
    float pixels_long = sqrt(length_squared) / clip.w;
    float pixels_wide = abs(cross_product(edge, c.off - a.off)) / (clip.w * clip.w) / pixels_long;
    float foot = dot(c.off - a.off, edge) / length_squared; // of c on the edge
    const float narrowest = 1.0 / 64.0; // pixels: below, floats do not tell the width
    float share_along = 1.0 / max(pixels_long, narrowest);
    float share_across = 1.0 / max(pixels_wide, narrowest);
    vec3 edge_from_eye = b.from_eye - a.from_eye;
    place_per_pixel = mat2(to_b * share_along, (to_c - foot * to_b) * share_across);
    local_per_pixel = mat2x3(edge_from_eye * share_along,
                             (c.from_eye - a.from_eye - foot * edge_from_eye) * share_across);
}

void set_from_corners() {
    Corner a = corner_of(vertex_of(first_corner));
    Corner b = corner_of(vertex_of(first_corner + 1));
    Corner c = corner_of(vertex_of(first_corner + 2));
    vec3 squares = vec3(squared(b.off - a.off), squared(c.off - b.off), squared(a.off - c.off));
    if (squares.x >= max(squares.y, squares.z)) {
        set_between(a, b, c);
    } else if (squares.y >= squares.z) {
        set_between(b, c, a);
    } else {
        set_between(c, a, b);
    }
}

float distance_to_eye() {
    return length(way_from_eye);
}
