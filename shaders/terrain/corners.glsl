// The corners of slivers (sliver.glsl), and the vertices of their tile.
layout(std430, binding = tile_vertices_binding) readonly buffer TileVertices {
    float vertices[]; // view::GridVertex
};
layout(std430, binding = sliver_corners_binding) readonly buffer SliverCorners {
    uint sliver_corners[]; // three vertices a triangle
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
    uint at = 9u * sliver_corners[corner];
    return Vertex(vec3(vertices[at], vertices[at + 1u], vertices[at + 2u]), vertices[at + 3u],
                  vec2(vertices[at + 4u], vertices[at + 5u]),
                  vec3(vertices[at + 6u], vertices[at + 7u], vertices[at + 8u]));
}
