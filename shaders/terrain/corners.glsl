// The corners of slivers (sliver.glsl).
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
