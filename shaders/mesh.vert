#include "frame_block.glsl"

layout(location = 0) in vec3 position; // local metres
layout(location = 1) in vec3 normal;

uniform mat4 relative_from_local;
uniform mat3 world_from_normal;

out vec3 relative_position;
out vec3 world_normal;

void main() {
    vec4 relative = relative_from_local * vec4(position, 1.0);
    relative_position = relative.xyz;
    world_normal = world_from_normal * normal;
    gl_Position = clip_from_relative * relative;
}
