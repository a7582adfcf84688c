// The searches along bent rays: of the true hit in chords, of steps along the curve, of parallax along its
// tangent.

// Scales columns and rows so that the way has its length in metres.
void set_metres(vec3 span, float metres) {
    float rise = span.z * space_scale.z;
    float run = sqrt(max(metres * metres - rise * rise, 0.0));
    float units = length(span.xy);
    metres_per_unit.xy = vec2(units > 0.0 ? run / units : 1.0);
}

#ifdef FADE
void fade_curve(vec3 span) {
    float share = share_of_heights(span);
    curve.eye.z = fade_reference_height + (curve.eye.z - fade_reference_height) / share;
    for (int i = 0; i < 4; ++i) {
        curve.terms[i].z /= share;
    }
}
#endif

#if defined(EXACT) || defined(CONE)
// `above`: the ray comes from above the search space.
bool find_in_chords(Chords chords, bool above, out float part, out vec2 place) {
    float before = chords.first * chords.first;
    vec3 start = place_of_end(chords, before);
    for (float i = 1.0; i <= chords.count; ++i) {
        float next = end_of_chord(chords, i);
        vec3 end = place_of_end(chords, next);
        vec3 span = end - start;
        vec2 inside = parts_inside(start, span);
        if (inside.x < inside.y) {
            begins_above = above && inside.x <= 0.0;
            if (find_hit(start + inside.x * span, (inside.y - inside.x) * span, part, place)) {
                part = mix(before, next, mix(inside.x, inside.y, part));
                return true;
            }
        }
        above = inside.x < inside.y && inside.y >= 1.0 && ends_above;
        before = next;
        start = end;
    }
    return false;
}
#elif defined(PARALLAX)
// Along the tangent where the ray reaches the reference plane.
bool find_at_reference(vec2 range, out float part, out vec2 place) {
    part = range.x;
    for (int i = 0; i < 8; ++i) { // Newton's method, from above
        part += (-parallax_offset - curve_at(part).z) / min(curve_slope_at(part).z, -1e-30);
    }
    if (!(part >= range.x && part <= range.y)) {
        return false;
    }
    vec3 slope = curve_slope_at(part);
    float way = range.y - range.x;
    float found;
    bool is_found = find_hit(curve_at(part) - (part - range.x) * slope, way * slope, found, place);
    part = range.x + found * way;
    return is_found;
}
#endif

// The part of the way to where the ray leaves the box.
bool find_on_curve(out float part, out vec2 place) {
    curve = curve_along(back);
    float metres = length(back);
    float begin = clamp(near_depth / dot(back, view_forward.xyz), 0.0, 1.0);
    vec2 range = falling_range(begin);
#if defined(EXACT) || defined(CONE)
    bool is_inside = range.x <= range.y;
#else
    const float share_of_chords = 0.125; // enough for the ends of the range
    range = range_inside(chords_between(range, metres, share_of_chords));
    bool is_inside = range.x <= range.y;
#endif
    vec3 way = curve_at(range.y) - curve_at(range.x);
    set_metres(way, (range.y - range.x) * metres);
#ifdef FADE
    fade_curve(way);
    vec2 faded = falling_range(begin);
    range = vec2(max(range.x, faded.x), min(range.y, faded.y));
    is_inside = is_inside && range.x <= range.y;
    way = curve_at(range.y) - curve_at(range.x);
#endif
    if (!is_inside) {
        return false;
    }
#if defined(EXACT) || defined(CONE)
    return find_in_chords(chords_between(range, metres, 1.0), range.x > begin, part, place);
#elif defined(PARALLAX)
    return find_at_reference(range, part, place);
#else
    curve_range = range;
    bool found = find_hit(curve_at(range.x), way, part, place);
    part = mix(range.x, range.y, part);
    return found;
#endif
}
