// Rays to the sun: straight on the Earth, bent in samples.

#ifdef DEGREES
#include "curved/degree_light.glsl"
#else
#include "curved/polynomial_light.glsl"
#endif

// Visible share of the sun.
float sun_over_earth(vec2 place, vec3 relative) {
    Curve view = curve;
    vec2 view_range = curve_range;
    vec3 metres_of_view = metres_per_unit;
#ifdef FACING
    SurfaceCell cell = surface_cell(place);
    curve = light_curve(vec3(place, height_in(cell) + shadow_lift), relative);
    if (!faces_sun(cell, curve_slope_at(0.0))) {
        curve = view;
        return 0.0;
    }
#else
    curve = light_curve(vec3(place, height_at(place) + shadow_lift), relative);
#endif
    count_ray();
    vec2 range = vec2(0.0, light_end_part());
#if defined(SOFT_SHADOW) || !(defined(EXACT) || defined(CONE))
    range = vec2(0.0, range_inside(range).y);
#endif
    vec3 start = curve_at(0.0);
    vec3 way = nearest_turn(start, curve_at(range.y)) - start;
    set_metres(way, range.y * light_begin.w);
    curve_range = range;
    float share = share_of_sun(start, way);
    curve = view;
    curve_range = view_range;
    metres_per_unit = metres_of_view;
    return share;
}
