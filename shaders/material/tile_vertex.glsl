#include "frame/detail_block.glsl"

// The vertices of a mesh with surface detail.
layout(location = 0) in vec3 position; // local metres
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 texture_coordinate;
layout(location = 3) in vec4 tangent; // w: handedness
layout(location = 4) in vec2 density; // texture coordinates per metre, along and across the tangent

uniform mat4 relative_from_local; // world directions relative to the eye, metres

out vec3 vertex_relative; // from the eye, metres
out vec3 vertex_normal;
out vec4 vertex_tangent;
out vec2 vertex_coordinate;
out vec2 vertex_tiles_per_metre;
#ifdef MULTISAMPLED
out float one;
#endif

void main() {
    vec4 place = relative_from_local * vec4(position, 1.0);
    vertex_relative = place.xyz;
    vertex_normal = normal;
    vertex_tangent = tangent;
    vertex_coordinate = texture_coordinate * repeats;
    vertex_tiles_per_metre = density * repeats;
#ifdef MULTISAMPLED
    one = vertex_grid.z;
#endif
    gl_Position = clip_from_relative * place;
}
