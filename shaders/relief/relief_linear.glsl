// Equal steps until one lies below the surface; then bisection (Policarpo, Oliveira and Comba 2005) or the
// bracketed secant method (Risser, Shah and Pattanaik 2006).
#define EQUAL_STEPS

int steps_for(vec3 span) {
#ifdef VIEW_STEPS
    return int(ceil(mix(steps_along_ground, steps_from_above, uprightness(span))));
#else
    return int(linear_steps);
#endif
}

// Between `part` at clearance `over` (>= 0) and `low_part` at `under` (< 0).
float narrowed(vec3 start, vec3 span, float part, float over, float low_part, float under) {
#if defined(BISECT)
    for (float i = 0.0; i < bisection_steps; ++i) {
        count_step();
        float middle = 0.5 * (part + low_part);
        vec3 p = ray_at(start, span, middle);
        if (p.z < height_at(p.xy)) {
            low_part = middle;
        } else {
            part = middle;
        }
    }
    return low_part;
#elif defined(SECANT)
    float rounds = secant_steps - 1.0;
    for (float i = 0.0; i < rounds; ++i) {
        count_step();
        float guess = mix(part, low_part, over / (over - under));
        vec3 p = ray_at(start, span, guess);
        float above = p.z - height_at(p.xy);
        if (above < 0.0) {
            low_part = guess;
            under = above;
        } else {
            part = guess;
            over = above;
        }
    }
    return mix(part, low_part, over / (over - under));
#else
    return low_part;
#endif
}

// The first crossing from above to below on the way from start to start + span.
bool find_hit(vec3 start, vec3 span, out float part, out vec2 place) {
    int n = steps_for(span);
    float before = start.z - height_at(start.xy);
    float at = 0.0;
    float under = 0.0;
    bool found = false;
    for (int i = 1; i <= n; ++i) {
        count_step();
        float next = float(i) / float(n);
        vec3 p = ray_at(start, span, next);
        float now = p.z - height_at(p.xy);
        if (now < 0.0 && before >= 0.0) {
            under = now;
            found = true;
            break;
        }
        at = next;
        before = now;
    }
    part = found ? narrowed(start, span, at, before, at + 1.0 / float(n), under) : 1.0;
    place = ray_at(start, span, part).xy;
    return found;
}
