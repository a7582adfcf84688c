// In slivers (view::SliverView) rasterizers interpolate wrongly, so values come from the corners.
#include "terrain/corners.glsl"

flat in int first_corner;

struct Corner {
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

Corner corner_of(Vertex vertex) {
    precise vec3 from_eye = (vertex.position - eye) + (vertex.rest - eye_rest);
    vec4 clip = clip_from_relative * vec4(world_from_local * from_eye, 1.0);
    vec2 at = 2.0 * gl_FragCoord.xy * pixel_share.xy - 1.0;
    return Corner(from_eye, clip, (clip.xy - at * clip.w) / pixel_share.xy);
}

float cross_product(vec2 a, vec2 b) {
    return a.x * b.y - a.y * b.x;
}

// Shares of three corners in the fragment, which is at 0. `a` to `b` is the longest edge. Along it the shares
// are exact; across it, where floats may not tell the corners apart, they are in the triangle.
vec3 shares_along(vec2 a, vec2 b, vec2 c) {
    const float tiny = 1e-30;
    vec2 edge = b - a;
    vec2 side = c - a;
    float length_squared = max(dot(edge, edge), tiny);
    float part = clamp(-dot(a, edge) / length_squared, 0.0, 1.0);
    float part_of_c = clamp(dot(side, edge) / length_squared, 0.0, 1.0);
    float most_of_c = min(part / max(part_of_c, tiny), (1.0 - part) / max(1.0 - part_of_c, tiny));
    float across = cross_product(edge, side);
    float of_c = across == 0.0 ? 0.0 : clamp(cross_product(a, edge) / across, 0.0, min(most_of_c, 1.0));
    float of_b = part - of_c * part_of_c;
    return vec3(1.0 - of_c - of_b, of_b, of_c);
}

vec3 shares_of(vec2 a, vec2 b, vec2 c) {
    vec3 squares = vec3(dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c));
    if (squares.x >= max(squares.y, squares.z)) {
        return shares_along(a, b, c);
    }
    return squares.y >= squares.z ? shares_along(b, c, a).zxy : shares_along(c, a, b).yzx;
}

void set_from_corners() {
    Vertex first = vertex_of(first_corner);
    Vertex second = vertex_of(first_corner + 1);
    Vertex third = vertex_of(first_corner + 2);
    Corner a = corner_of(first);
    Corner b = corner_of(second);
    Corner c = corner_of(third);
    vec3 shares = shares_of(a.off, b.off, c.off);
    local_from_eye = mat3(a.from_eye, b.from_eye, c.from_eye) * shares;
    way_from_eye = world_from_local * local_from_eye;
    true_height = dot(vec3(first.height, second.height, third.height), shares);
    corner_place = first.place;
    from_corner = shares.y * (second.place - first.place) + shares.z * (third.place - first.place);
    tile_place = corner_place + from_corner;
    vec4 clip = shares.x * a.clip + shares.y * b.clip + shares.z * c.clip;
    gl_FragDepth = clip.z / clip.w;
}

float distance_to_eye() {
    return length(way_from_eye);
}
