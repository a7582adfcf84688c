#include "frame/frame_block.glsl"
#include "frame/surface_light.glsl"
#include "frame/air.glsl"
#include "material/surface_shader.glsl"
#include "frame/fragment.glsl"
#include "frame/distance.glsl"
#ifdef POINT_LIGHTS
#include "material/point_lights.glsl"
#endif
#ifdef MESH_SHADOWS
#include "mesh/sun_on_mesh.glsl"
#endif

in vec3 world_normal;
#ifdef HIT
in float view_depth;
#endif

uniform vec3 albedo; // linear

#include "frame/output.glsl"

void main() {
#ifdef HIT
    hit = vec4(-1.0, -1.0, 0.0, view_depth);
    hit_low = vec2(0.0);
#else
    vec3 normal = normalize(INSIDE(world_normal));
#ifdef MESH_SHADOWS
    float sun = sun_on_mesh(INSIDE(way_from_eye), dFdx(FROM_PIXEL_TO_PIXEL(way_from_eye)),
                            dFdy(FROM_PIXEL_TO_PIXEL(way_from_eye)));
#else
    const float sun = 1.0;
#endif
    vec3 lit = lit_color(albedo, normal, sun);
#ifdef POINT_LIGHTS
    lit += albedo * light_of_points(INSIDE(way_from_eye), normal);
#endif
    keep_surface(albedo, normal);
    color = vec4(seen_through_air(shaded(lit, INSIDE(way_from_eye)), distance_to_eye()), 1.0);
#endif
}
