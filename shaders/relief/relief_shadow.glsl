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
float shadow_steps(vec3 span) {
#ifdef EQUAL_STEPS
    return steps_for(span);
#else
    return clamp(ceil(max(abs(span.x), abs(span.y))), 1.0, 4096.0); // one per sample
#endif
}

// From the deepest penetration (GPU surface-detail survey 2008 ch. 3.6.6).
float share_of_sun(vec3 start, vec3 span) {
    float n = shadow_steps(span);
    float deepest = 0.0;
    for (float i = 1.0; i <= n && deepest < shadow_depth; ++i) {
        count_step();
        vec3 p = ray_at(start, span, i / n);
        deepest = max(deepest, depth_in_surface(p));
    }
    return clamp(1.0 - deepest / shadow_depth, 0.0, 1.0);
}
#else
// 1 if the ray is free (Policarpo, Oliveira and Comba 2005).
float share_of_sun(vec3 start, vec3 span) {
    float part;
    vec2 place;
#ifdef CURVED
    return find_between(curve_range, false, part, place) ? 0.0 : 1.0;
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
