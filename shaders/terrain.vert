#include "frame_block.glsl"

layout(location = 0) in vec3 position; // metres from the tile's origin
#ifdef HIT
layout(location = 1) in float height; // true metres
#endif

uniform mat4 relative_from_tile; // world directions relative to the eye, metres
uniform vec4 tile_samples;       // xy: col, row of the first vertex; zw: samples from vertex to vertex
uniform float vertices_per_row;
uniform float rows_per_vertex; // its inverse

out vec2 tile_place; // samples from the tile's first vertex
#ifdef HIT
out vec2 height_and_depth; // true metres; metres along the view axis
#endif

void main() {
    vec4 relative = relative_from_tile * vec4(position, 1.0);
    // Exact below 65,536 vertices, and far cheaper than a division of integers.
    float row = floor((float(gl_VertexID) + 0.5) * rows_per_vertex);
    float col = float(gl_VertexID) - row * vertices_per_row;
    tile_place = vec2(col, row) * tile_samples.zw;
#ifdef HIT
    height_and_depth = vec2(height, dot(relative.xyz, view_forward.xyz));
#endif
    gl_Position = clip_from_relative * relative;
}
