#include "frame/detail_block.glsl"

// The vertices of a mesh that carries a tile of detail.
layout(location = 0) in vec3 position; // local metres
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 texture_coordinate;
layout(location = 3) in vec4 tangent; // w: handedness
layout(location = 4) in vec2 density; // texture coordinates a metre, along the tangent and across

uniform mat4 relative_from_local; // world directions relative to the eye, metres

out vec3 relative; // from the eye, metres
out vec3 local_normal;
out vec4 local_tangent;
out vec2 tile_coordinate;
out vec2 tiles_per_metre;

void main() {
    vec4 place = relative_from_local * vec4(position, 1.0);
    relative = place.xyz;
    local_normal = normal;
    local_tangent = tangent;
    tile_coordinate = texture_coordinate * repeats;
    tiles_per_metre = density * repeats;
    gl_Position = clip_from_relative * place;
}
