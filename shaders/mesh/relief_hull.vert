#include "frame/frame_block.glsl"

// One tetrahedron per instance: a strip of its four sides, which face inwards.
layout(location = 0) in vec4 corner_0; // local metres; w: height
layout(location = 1) in vec4 corner_1;
layout(location = 2) in vec4 corner_2;
layout(location = 3) in vec4 corner_3;
layout(location = 4) in vec4 coordinates_01;
layout(location = 5) in vec4 coordinates_23;
layout(location = 6) in vec4 normal_0; // w: 1: the side opposite the corner lies on a hard edge
layout(location = 7) in vec4 normal_1;
layout(location = 8) in vec4 normal_2;
layout(location = 9) in vec4 normal_3;

uniform mat4 relative_from_local; // world directions relative to the eye, metres

out vec3 vertex_relative;
out vec4 vertex_shares;
#ifdef MULTISAMPLED
out float one;
#endif
flat out mat3 shares_of_way;
flat out mat4x2 coordinates;
flat out vec4 heights;
flat out mat4x3 corner_normals;
flat out vec4 hard_edges;

void main() {
    mat4 corners = mat4(corner_0, corner_1, corner_2, corner_3);
    int corner = gl_VertexID & 3;
    vec4 place = relative_from_local * vec4(corners[corner].xyz, 1.0);
    vertex_relative = place.xyz;
    vertex_shares = vec4(0.0);
    vertex_shares[corner] = 1.0;
#ifdef MULTISAMPLED
    one = vertex_grid.z;
#endif
    shares_of_way = inverse(mat3(corner_1.xyz - corner_0.xyz, corner_2.xyz - corner_0.xyz,
                                 corner_3.xyz - corner_0.xyz));
    coordinates = mat4x2(coordinates_01.xy, coordinates_01.zw, coordinates_23.xy, coordinates_23.zw);
    heights = vec4(corner_0.w, corner_1.w, corner_2.w, corner_3.w);
    corner_normals = mat4x3(normal_0.xyz, normal_1.xyz, normal_2.xyz, normal_3.xyz);
    hard_edges = vec4(normal_0.w, normal_1.w, normal_2.w, normal_3.w);
    gl_Position = clip_from_relative * place;
}
