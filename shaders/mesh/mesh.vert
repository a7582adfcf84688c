#include "frame/frame_block.glsl"

layout(location = 0) in vec3 position; // local metres
layout(location = 1) in vec3 normal;

uniform mat4 relative_from_local;
uniform mat3 world_from_normal;

out vec3 world_normal;
#if defined(MULTISAMPLED) || defined(POINT_LIGHTS) || defined(MESH_SHADOWS) || defined(SURFACE_SHADER)
out vec3 way_from_eye; // metres
#endif
#ifdef MULTISAMPLED
out float one;
#endif
#ifdef HIT
out float view_depth; // metres along the view axis
#endif

void main() {
    vec4 relative = relative_from_local * vec4(position, 1.0);
    world_normal = world_from_normal * normal;
#if defined(MULTISAMPLED) || defined(POINT_LIGHTS) || defined(MESH_SHADOWS) || defined(SURFACE_SHADER)
    way_from_eye = relative.xyz;
#endif
#ifdef MULTISAMPLED
    one = vertex_grid.z;
#endif
#ifdef HIT
    view_depth = dot(relative.xyz, view_forward.xyz);
#endif
    gl_Position = clip_from_relative * relative;
}
