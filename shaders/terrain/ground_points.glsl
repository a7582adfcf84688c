// The light of point lights on a terrain (scene::PointLight). A surface shader gets the same albedo and normal.
#include "material/point_lights.glsl"
#ifdef STREAMED
#define GROUND_MAP sampler2DArray
#else
#define GROUND_MAP sampler2D
#endif
layout(binding = lit_albedo_unit) uniform GROUND_MAP lit_albedo;   // linear
layout(binding = lit_normals_unit) uniform GROUND_MAP lit_normals; // local

uniform mat3 world_from_normal;

vec3 reflected_from_points(vec3 albedo, vec3 local_normal, vec3 relative) {
    vec3 normal = normalize(world_from_normal * local_normal);
    keep_surface(albedo, normal);
    return albedo * light_of_points(relative, normal);
}
