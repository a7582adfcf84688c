#include "frame/frame_block.glsl"

// One triangle over the whole picture, at the far end of the reversed depth.
out vec3 ray;

void main() {
    vec2 place = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2);
    ray = ray_corner.xyz + place.x * ray_right.xyz + place.y * ray_up.xyz;
    gl_Position = vec4(2.0 * place - 1.0, 0.0, 1.0);
}
