// The place that a ray narrowly misses (GPU surface-detail survey 2008 ch. 3.6.7): the hit of a lowered ray,
// then the nearest place.

float clearance(vec3 point) {
    return point.z - height_at(point.xy);
}

// The nearest part between two, by ternary search to 1/60 of the range.
float nearest_part(vec3 start, vec3 way, float low, float high) {
    for (float i = 0.0; i < 10.0; ++i) {
        float third = (high - low) / 3.0;
        bool earlier = clearance(start + (low + third) * way) <
                       clearance(start + (high - third) * way);
        low += earlier ? 0.0 : third;
        high -= earlier ? third : 0.0;
    }
    return 0.5 * (low + high);
}

// Distance to the missed place in units of edge_distance; 1 without one.
float near_miss(vec3 start, vec3 span, float part, out vec2 place) {
    const float max_steps = 64.0;
    vec3 way = part * span;
    float at;
    place = start.xy;
    if (!find_hit(start - vec3(0.0, 0.0, edge_distance), way, at, place)) {
        return 1.0;
    }
    // From there one sample at a time to the nearest of all places.
    float samples = max(max(abs(way.x), abs(way.y)), 1.0);
    float stride = max(1.0 / samples, (1.0 - at) / max_steps);
    float before = edge_distance;
    float nearest_clearance = edge_distance;
    float passed = -1.0;
    bool nearing = true;
    while (at < 1.0) {
        at += stride;
        float now = clearance(start + min(at, 1.0) * way);
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
    vec3 nearest = start + nearest_part(start, way, begin, min(passed, 1.0)) * way;
    place = nearest.xy;
    return clamp(clearance(nearest) / edge_distance, 0.0, 1.0);
}
