// A shadow ray with the same search.

// The margin of the box: avoids self-shadowing by rounding.
const float shadow_lift = 1.0 / 4096.0;

// The way from a point to the ray's exit from the box.
vec3 way_out(vec3 point, vec3 direction, vec3 low, vec3 high) {
    vec3 away = vec3(equal(direction, vec3(0.0)));
    vec3 ends = mix(low, high, vec3(greaterThan(direction, vec3(0.0))));
    vec3 parts = (ends - point) / (direction + away) + away * 3e38;
    return max(min(min(parts.x, parts.y), parts.z), 0.0) * direction;
}

#ifdef SOFT_SHADOW
int shadow_steps(vec3 span) {
#ifdef EQUAL_STEPS
    return steps_for(span);
#else
    return int(clamp(ceil(max(abs(span.x), abs(span.y))), 1.0, 4096.0)); // one per sample
#endif
}

// From the deepest penetration (GPU surface-detail survey 2008 ch. 3.6.6).
float share_of_sun(vec3 start, vec3 span) {
    int n = shadow_steps(span);
    float deepest = 0.0;
    for (int i = 1; i <= n && deepest < shadow_depth; ++i) {
        count_step();
        vec3 p = ray_at(start, span, float(i) / float(n));
        deepest = max(deepest, depth_in_surface(p));
    }
    return clamp(1.0 - deepest / shadow_depth, 0.0, 1.0);
}
#else
// 1 if the ray is free (Policarpo, Oliveira and Comba 2005). It begins where cones are closed: their minimum steps
// would skip what hides the sun.
float share_of_sun(vec3 start, vec3 span) {
    float part;
    vec2 place;
#ifdef CURVED
    return find_between(curve_range, false, part, place) ? 0.0 : 1.0;
#elif defined(CONE) && !defined(TILE)
    return find_exact_hit(start, span, part, place) ? 0.0 : 1.0;
#else
    return find_hit(start, span, part, place) ? 0.0 : 1.0;
#endif
}
#endif

// Visible share of the sun; `low` and `high` bound the search space.
float sun_at(vec2 place, vec3 sun_direction, vec3 low, vec3 high) {
    count_ray();
    vec3 start = vec3(place, height_at(place) + outward() * shadow_lift);
    return share_of_sun(start, way_out(start, sun_direction, low, high));
}

#if defined(HARD_SHADOW) && !defined(TILE) && !defined(LAYERS)
#define FACING
// Whether the surface rises less than the ray to the sun. If not, that ray leads into the ground, whatever rounding
// makes of its start.
bool faces_sun(SurfaceCell cell, vec3 sun_direction) {
    vec4 h = cell.corners;
    vec2 slopes = vec2(mix(h.z - h.w, h.y - h.x, cell.part.y), mix(h.x - h.w, h.y - h.z, cell.part.x));
    return dot(slopes / cell.extent, sun_direction.xy) < sun_direction.z;
}

#ifndef CURVED
// Exact searches round heights in [0,1] by a few 2^-24. Others step over what is lower.
#if defined(EXACT) || defined(CONE)
const float hit_lift = 1.0 / 1048576.0;
#else
const float hit_lift = shadow_lift;
#endif

// Whether a ray of the same search reaches the sun.
float sun_from_hit(vec2 place, vec3 sun_direction, vec3 low, vec3 high) {
    SurfaceCell cell = surface_cell(place);
    if (!faces_sun(cell, sun_direction)) {
        return 0.0;
    }
    count_ray();
    vec3 start = vec3(place, height_in(cell) + hit_lift);
    return share_of_sun(start, way_out(start, sun_direction, low, high));
}
#endif
#endif
