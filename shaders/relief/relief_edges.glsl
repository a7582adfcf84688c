// The place that a ray narrowly misses (GPU surface-detail survey 2008 ch. 3.6.7): the hit of a lowered ray,
// then the nearest place.

float clearance(vec3 point) {
    return point.z - height_at(point.xy);
}

// The nearest part between two, by ternary search to 1/60 of the range.
float nearest_part(vec3 start, vec3 way, float low, float high) {
    for (float i = 0.0; i < 10.0; ++i) {
        float third = (high - low) / 3.0;
        bool earlier = clearance(ray_at(start, way, low + third)) <
                       clearance(ray_at(start, way, high - third));
        low += earlier ? 0.0 : third;
        high -= earlier ? third : 0.0;
    }
    return 0.5 * (low + high);
}

// The part of the way, and the place.
bool find_lowered_hit(vec3 start, vec3 way, out float at, out vec2 place) {
#ifdef CURVED
    vec2 range = curve_range;
    curve.eye.z -= edge_distance;
    bool found = find_between(range, false, at, place);
    curve.eye.z += edge_distance;
    curve_range = range;
    at = (at - range.x) / max(range.y - range.x, 1e-30);
    return found;
#else
    return find_hit(start - vec3(0.0, 0.0, edge_distance), way, at, place);
#endif
}

// Distance to the missed place in units of edge_distance; 1 without one. `way`: of the ray to its hit. `at`: the
// part of it where the place is missed.
float near_miss(vec3 start, vec3 way, out float at, out vec2 place) {
    const float max_steps = 64.0;
    place = start.xy;
    if (!find_lowered_hit(start, way, at, place)) {
        return 1.0;
    }
    // From there one sample at a time to the nearest of all places.
    float samples = max(max(abs(way.x), abs(way.y)), 1.0);
    float stride = max(1.0 / samples, (1.0 - at) / max_steps);
    float before = edge_distance;
    float nearest_clearance = edge_distance;
    float passed = -1.0;
    bool nearing = true;
    int steps = int(clamp(ceil((1.0 - at) / stride), 0.0, max_steps));
    for (int i = 0; i < steps; ++i) {
        at += stride;
        float now = clearance(ray_at(start, way, min(at, 1.0)));
        if (nearing && now > before && before <= nearest_clearance) {
            nearest_clearance = before;
            passed = at;
        }
        nearing = now <= before;
        before = now;
    }
    if (passed < 0.0) {
        return 1.0;
    }
    float begin = max(passed - 2.0 * stride, 0.0);
    at = nearest_part(start, way, begin, min(passed, 1.0));
    vec3 nearest = ray_at(start, way, at);
    place = nearest.xy;
    return clamp(clearance(nearest) / edge_distance, 0.0, 1.0);
}
