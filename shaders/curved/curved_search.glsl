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

// Chords of equal length in the square root of the part are seen from part 0 beside the curve by equal angles
// (view/ray_course.h). Their ends lie beyond the curve by half of that, so that their middles do not.
struct Chords {
    float first; // square root of the part
    float stride;
    int count;
};

// `share`: of the number that keeps the error.
Chords chords_between(vec2 range, float share) {
    float first = sqrt(range.x);
    float way = max(sqrt(range.y) - first, 0.0);
    const float max_chords = 65536.0;
    float count = clamp(ceil(way * share * curve.chords), 1.0, max_chords);
    return Chords(first, way / count, int(count));
}

float end_of_chord(Chords chords, int i) {
    float root = chords.first + float(i) * chords.stride;
    return root * root;
}

vec3 place_of_end(Chords chords, float part) {
    return curve_at(part) - 0.25 * chords.stride * chords.stride * part * curve_bend_at(part);
}

// The parts between which a ray may be among the heights of the search space; the second is smaller if it is
// not. Heights along a ray are convex, so tangents lie below them, and chords above.
vec2 falling_range(float begin) {
    vec2 range = vec2(begin, 1.0);
    for (int i = 0; i < 3; ++i) {
        float over = curve_at(range.x).z - curve.high.z;
        float slope = curve_slope_at(range.x).z;
        if (over > 0.0) {
            range.x = slope < 0.0 ? range.x - over / slope : 2.0;
        }
    }
    for (int i = 0; i < 3; ++i) {
        float over = curve_at(range.y).z - curve.high.z;
        float slope = curve_slope_at(range.y).z;
        range.y -= over > 0.0 && slope > 0.0 ? over / slope : 0.0;
    }
    for (int i = 0; i < 2; ++i) {
        float over = curve_at(range.x).z - curve.low.z;
        float under = curve_at(range.y).z - curve.low.z;
        if (over > 0.0 && under < 0.0) {
            range.y = mix(range.x, range.y, over / (over - under));
        }
    }
    return range;
}

// The parts of a chord in the searched space; the second is smaller if there are none.
vec2 parts_inside(vec3 start, vec3 span) {
    vec3 still = vec3(equal(span, vec3(0.0)));
    vec3 inverse = 1.0 / (span + still * 1e-30); // a border away from it: infinitely far
    vec3 low = (curve.low - start) * inverse;
    vec3 high = (curve.high - start) * inverse;
    vec3 first = min(low, high);
    vec3 last = max(low, high);
    return vec2(max(max(first.x, first.y), max(first.z, 0.0)),
                min(min(last.x, last.y), min(last.z, 1.0)));
}

// The parts of the ray between which it is in the searched space.
vec2 range_inside(vec2 range) {
    const float share_of_chords = 0.125; // enough for the ends of the range
    Chords chords = chords_between(range, share_of_chords);
    vec2 inner = vec2(2.0, 0.0);
    float before = chords.first * chords.first;
    vec3 start = curve_at(before);
    for (int i = 1; i <= chords.count; ++i) {
        float next = end_of_chord(chords, i);
        vec3 end = curve_at(next);
        vec2 inside = parts_inside(start, end - start);
        if (inside.x <= inside.y) {
            inner = vec2(min(inner.x, mix(before, next, inside.x)), mix(before, next, inside.y));
        } else if (inner.x <= 1.0) {
            break;
        }
        before = next;
        start = end;
    }
    return inner;
}

#if defined(EXACT) || defined(CONE)
bool find_between(vec2 range, bool above, out float part, out vec2 place) {
    Chords chords = chords_between(range, 1.0);
    float before = chords.first * chords.first;
    vec3 start = place_of_end(chords, before);
    for (int i = 1; i <= chords.count; ++i) {
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
#else
bool find_between(vec2 range, bool above, out float part, out vec2 place) {
    curve_range = range;
    vec3 start = curve_at(range.x);
    bool found = find_hit(start, curve_at(range.y) - start, part, place);
    part = mix(range.x, range.y, part);
    return found;
}
#endif

// The part of the way to where the ray leaves the box.
bool find_on_curve(out float part, out vec2 place) {
    back = back_on_ray();
    curve = view_curve(back);
    float depth = dot(back, view_forward.xyz);
    float begin = clamp(near_depth / depth, 0.0, 1.0);
    vec2 range = falling_range(begin);
#if !defined(EXACT) && !defined(CONE)
    range = range_inside(range);
#endif
    vec3 way = curve_at(range.y) - curve_at(range.x);
    set_metres(way, (range.y - range.x) * length(back));
#ifdef FADE
    fade_curve(way);
    vec2 faded = falling_range(begin);
    range = vec2(max(range.x, faded.x), min(range.y, faded.y));
#endif
#ifdef BEAMS
    range.x = max(range.x, clear_part(depth));
#endif
    if (!(range.x <= range.y)) {
        return false;
    }
#ifdef PARALLAX
    return find_at_reference(range, part, place);
#else
    bool found = find_between(range, range.x > begin, part, place);
    curve_range = vec2(range.x, part);
    return found;
#endif
}
