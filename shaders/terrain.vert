#include "frame_block.glsl"

layout(location = 0) in vec3 position; // metres from the tile's origin
layout(location = 1) in float height;  // true metres

uniform mat4 relative_from_tile; // world directions relative to the eye, metres
uniform vec4 tile_samples;       // xy: col, row of the first vertex; zw: samples from vertex to vertex
uniform int vertices_per_row;

out vec3 relative_position; // from the eye, metres
out vec2 tile_place;        // samples from the tile's first vertex
out float surface_height;   // true metres

void main() {
    vec4 relative = relative_from_tile * vec4(position, 1.0);
    ivec2 vertex = ivec2(gl_VertexID % vertices_per_row, gl_VertexID / vertices_per_row);
    relative_position = relative.xyz;
    tile_place = vec2(vertex) * tile_samples.zw;
    surface_height = height;
    gl_Position = clip_from_relative * relative;
}
