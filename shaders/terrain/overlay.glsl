// What is drawn over ground: its grain, façades and contours, as packets of rays paint them (engine/cast/packet).
layout(std140, binding = overlay_block_binding) uniform OverlayBlock {
#include "frame/overlay_block.inc"
};
#include "terrain/overlay_numbers.inc"

// A visible place of ground. Vectors lie along the axes of the patterns (view::GrainView).
struct GroundPlace {
    vec3 from_eye; // metres
    vec3 normal;   // unit vectors
    vec3 up;
    vec3 view;     // away from the eye
    float pixel;   // width across the view, metres
};

vec3 along_turned_axes(vec3 world) {
    return vec3(dot(grain_turn.xy, world.xy), grain_turn.x * world.y - grain_turn.y * world.x, world.z);
}

// `relative`: from the eye, world metres; `perpendicular`: to the surface, along the turned axes.
GroundPlace ground_place(vec3 relative, vec3 perpendicular) {
    vec3 from_eye = along_turned_axes(relative);
    float distance = max(length(from_eye), 1e-30);
    float radius = grain_turn.w;
    vec3 up = radius > 0.0 ? normalize(radius * grain_up.xyz + from_eye) : grain_up.xyz;
    float area = length(perpendicular);
    vec3 normal = area > 0.0 ? perpendicular / area : up;
    normal *= dot(normal, up) < 0.0 ? -1.0 : 1.0;
    vec3 view = perspective > 0.5 ? from_eye / distance : along_turned_axes(view_forward.xyz);
    float pixel = metres_a_pixel.x + metres_a_pixel.y * distance;
    return GroundPlace(from_eye, normal, up, view, pixel);
}
#ifdef POINT_LIGHTS
vec3 light_under_overlay = vec3(0.0); // of point lights

// The inverse of along_turned_axes().
vec3 along_world_axes(vec3 turned) {
    return vec3(grain_turn.x * turned.x - grain_turn.y * turned.y, dot(grain_turn.yx, turned.xy), turned.z);
}
#endif
#include "terrain/grain.glsl"
#include "terrain/contours.glsl"
#ifdef FACADES
#include "terrain/facade.glsl"
#endif

// `at`: sample; `height`: true metres. `has_slope`: the height changes.
vec3 overlaid(vec3 lit, GroundPlace place, vec2 at, float height, bool has_slope) {
    if (grain_up.w > 0.0) {
        lit = with_grain(lit, place, height);
    }
#ifdef POINT_LIGHTS
    else {
        lit += light_under_overlay;
    }
#endif
#ifdef FACADES
    lit = with_facades(lit, place, at, height);
#endif
    if (contours.x > 0.0 && has_slope) {
        lit = with_contours(lit, place, height);
    }
    return lit;
}
