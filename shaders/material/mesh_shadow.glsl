// Shadows of meshes: depth maps from the sun (Williams 1978), the finest one that shows a place. Two by two in a square.
layout(std140, binding = mesh_shadow_block_binding) uniform MeshShadowBlock {
#include "material/mesh_shadow.inc"
};
layout(binding = mesh_shadow_unit) uniform sampler2DShadow mesh_shadow;

// The part of the sun that meshes leave, from the four texels around a place; 1 outside of the maps. `relative`: from
// the eye, world metres. `sine`: of the angle between the normal of the mesh that is lit, if it is one, and the sun.
// Lifting by the diagonal of a texel times this sine, along the normal, is just enough: then no texel of a plane is
// nearer to the sun than the plane's lifted places are. What rounds is added.
float sun_beside_meshes(vec3 relative, vec3 normal, float sine) {
    const float rounding = 1.0 / 1048576.0; // of floats' distances
    for (int i = 0; i < int(mesh_shadow_numbers.x); ++i) {
        float texel = mesh_shadow_texels[i].x;
        float raised = texel * sine + rounding * (mesh_shadow_texels[i].y + length(relative));
        vec3 at = (mesh_shadow_maps[i] * vec4(relative + raised * normal, 1.0)).xyz;
        vec2 border = 2.0 / vec2(textureSize(mesh_shadow, 0));
        if (all(greaterThan(at.xy, border)) && all(lessThan(at.xy, 1.0 - border))) {
            vec2 corner = vec2(i & 1, i >> 1);
            return texture(mesh_shadow, vec3(0.5 * (corner + at.xy), max(at.z, 0.0))); // below all: 0, as where none is
        }
    }
    return 1.0;
}

// On ground, which is not in the maps.
float sun_on_ground(vec3 relative) {
    return sun_beside_meshes(relative, vec3(0.0), 0.0);
}
