// One look at the height where the ray meets the reference plane shifts the place along the ray
// (Kaneko et al. 2001); limited (Welsh 2004); or looked at again, the heights averaged.

bool find_hit(vec3 start, vec3 span, out float part, out vec2 place) {
    float offset = parallax_offset;
    part = (-offset - start.z) / span.z; // where the ray is at the reference plane
    if (!(part >= 0.0 && part <= 1.0 && span.z < 0.0)) {
        return false;
    }
    vec2 entry = start.xy + part * span.xy;
    // Samples the ray goes sideways while it rises by the whole range of heights.
    vec2 shift = span.xy / span.z;
#ifdef LIMITED
    vec3 to_eye = -normalize(span * metres_per_unit);
    shift *= to_eye.z; // divided by one, not by the height of the view vector
#endif
    float height = height_at(entry);
    place = entry + (height + offset) * shift;
#ifdef ITERATED
    for (float i = 0.0; i < parallax_iterations; ++i) {
        height = 0.5 * (height + height_at(place));
        place = entry + (height + offset) * shift;
    }
#endif
    return is_on_surface(place);
}
