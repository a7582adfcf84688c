#include "frame/frame_block.glsl"
#include "frame/relief_block.glsl"

// The bounding box of a surface: a strip of 14 vertices, visible from inside.
uniform mat4 relative_from_local; // world directions relative to the eye, metres

out vec3 vertex_back; // relative to the eye
#ifdef MULTISAMPLED
out float one;
#endif

void main() {
    int bit = 1 << gl_VertexID;
    vec3 corner = vec3((0x287A & bit) != 0, (0x02AF & bit) != 0, (0x31E3 & bit) != 0);
    vec4 relative = relative_from_local * vec4(mix(box_low.xyz, box_high.xyz, corner), 1.0);
    vertex_back = relative.xyz;
#ifdef MULTISAMPLED
    one = vertex_grid.z;
#endif
    gl_Position = clip_from_relative * relative;
}
