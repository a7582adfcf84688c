// What a material's own shader makes of the light that a surface reflects.
#ifdef SURFACE_SHADER
#include "material/surface.glsl"

uniform vec3 eye_place; // world metres

vec3 surface_albedo = vec3(1.0);
vec3 surface_normal = vec3(0.0, 0.0, 1.0);

#include "surface_shader"

vec3 shaded(vec3 light, vec3 from_eye) {
    return surface_color(Surface(light, surface_albedo, surface_normal, from_eye, eye_place + from_eye));
}
#else
#define shaded(light, from_eye) (light)
#endif

// For shaded().
void keep_surface(vec3 albedo, vec3 normal) {
#ifdef SURFACE_SHADER
    surface_albedo = albedo;
    surface_normal = normal;
#endif
}
