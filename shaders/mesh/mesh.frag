#include "frame/frame_block.glsl"
#include "frame/surface_light.glsl"
#include "frame/air.glsl"
#include "frame/fragment.glsl"
#include "frame/distance.glsl"

in vec3 world_normal;
#ifdef HIT
in float view_depth;
#endif

uniform vec3 albedo; // linear

#ifdef HIT
layout(location = 0) out vec4 hit; // col and row -1, depth
#else
layout(location = 0) out vec4 color;
#endif

void main() {
#ifdef HIT
    hit = vec4(-1.0, -1.0, 0.0, view_depth);
#else
    vec3 lit = lit_color(albedo, normalize(INSIDE(world_normal)), 1.0);
    color = vec4(seen_through_air(lit, distance_to_eye()), 1.0);
#endif
}
