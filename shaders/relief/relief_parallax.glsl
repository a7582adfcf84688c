// Shifts the place on the reference plane along the ray by its height (Kaneko et al. 2001); with offset
// limiting (Welsh 2004); or iterated with averaged heights.

// `shift`: samples per height of 1.
vec2 shifted(vec2 entry, float height, vec2 shift) {
    vec2 place = entry + (height + parallax_offset) * shift;
#ifdef CURVED
    place = within_turn(place);
#endif
    return place;
}

bool find_hit(vec3 start, vec3 span, out float part, out vec2 place) {
    float offset = parallax_offset;
    part = (-offset - start.z) / span.z; // on the reference plane
    if (!(part >= 0.0 && part <= 1.0 && span.z < 0.0)) {
        return false;
    }
    vec2 entry = start.xy + part * span.xy;
    vec2 shift = span.xy / span.z;
#ifdef LIMITED
    vec3 to_eye = -normalize(span * metres_per_unit);
    shift *= to_eye.z; // without the division by the view vector's height
#endif
    float height = height_at(entry);
    place = shifted(entry, height, shift);
#ifdef ITERATED
    for (float i = 0.0; i < parallax_iterations; ++i) {
        count_step();
        height = 0.5 * (height + height_at(place));
        place = shifted(entry, height, shift);
    }
#endif
    return is_on_surface(place);
}
