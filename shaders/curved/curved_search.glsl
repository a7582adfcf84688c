// The searches along bent rays: of the true hit in chords, of steps along the curve, of parallax along its
// tangent.

// Scales columns and rows so that the way has its length in metres.
void set_metres(vec3 span, float metres) {
    float rise = span.z * space_scale.z;
    float run = sqrt(max(metres * metres - rise * rise, 0.0));
    float units = length(span.xy);
    metres_per_unit.xy = vec2(units > 0.0 ? run / units : 1.0);
}

#ifdef DEGREES
#include "curved/degree_search.glsl"
#else
#include "curved/polynomial_search.glsl"
#endif

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

// The same where a chord may cross the longitude from where they begin anew.
vec2 parts_of_chord(vec3 start, vec3 end) {
    vec2 inside = parts_inside(start, end - start);
    float turns = turns_behind(end);
    if (turns != 0.0) {
        vec2 behind = parts_inside(turned(start, turns), end - start);
        bool is_inside = inside.x <= inside.y;
        if (behind.x <= behind.y) {
            inside = is_inside ? vec2(inside.x, behind.y) : behind;
        }
    }
    return inside;
}

// The parts of the ray between which it is in the searched space.
vec2 range_inside(vec2 range) {
    const float share_of_chords = 0.125; // enough for the ends of the range
    Chords chords = chords_between(range, share_of_chords);
    vec2 inner = vec2(2.0, 0.0);
    float before = first_end(chords);
    vec3 start = place_on_curve(chords, before);
    for (int i = 1; i <= chords.count && before < range.y; ++i) {
        float next = end_of_chord(chords, i, before);
        vec3 end = nearest_turn(start, place_on_curve(chords, next));
        vec2 inside = parts_of_chord(start, end);
        if (inside.x <= inside.y) {
            inner = vec2(min(inner.x, mix(before, next, inside.x)), mix(before, next, inside.y));
        } else if (inner.x <= 1.0) {
            break;
        }
        before = next;
        start = turned(end, turns_behind(end));
    }
    return inner;
}

#if defined(EXACT) || defined(CONE)
bool leaves_above = false; // the searched space: the last chord

// `part`: of the chord. `above`: whether its start is, and with `enters` where it enters the searched space; then
// whether its end is.
bool find_on_chord(vec3 start, vec3 span, bool enters, inout bool above, out float part, out vec2 place) {
    vec2 inside = parts_inside(start, span);
    if (inside.x < inside.y) {
        begins_above = above && (enters || inside.x <= 0.0);
        if (find_hit(start + inside.x * span, (inside.y - inside.x) * span, part, place)) {
            part = mix(inside.x, inside.y, part);
            return true;
        }
    }
    leaves_above = inside.x < inside.y && ends_above;
    above = leaves_above && inside.y >= 1.0;
    return false;
}

bool find_between(vec2 range, bool above, out float part, out vec2 place) {
    Chords chords = chords_between(range, 1.0);
    float before = first_end(chords);
    vec3 start = place_of_end(chords, before);
    for (int i = 1; i <= chords.count && before < range.y; ++i) {
        float next = end_of_chord(chords, i, before);
        vec3 end = nearest_turn(start, place_of_end(chords, next));
        bool found = find_on_chord(start, end - start, false, above, part, place);
        float turns = turns_behind(end);
        if (!found && turns != 0.0) { // the same chord, from where longitudes begin anew
            start = turned(start, turns);
            end = turned(end, turns);
            above = leaves_above;
            found = find_on_chord(start, end - start, true, above, part, place);
        }
        if (found) {
            part = mix(before, next, part);
            return true;
        }
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
    bool found = find_hit(start, nearest_turn(start, curve_at(range.y)) - start, part, place);
    part = mix(range.x, range.y, part);
    return found;
}
#endif

// The part of the way to where the ray leaves the box.
bool find_on_curve(out float part, out vec2 place) {
    curve = view_curve(back_on_ray());
    float begin = first_part_of_view();
    vec2 range = falling_range(begin);
#if !defined(EXACT) && !defined(CONE)
    range = range_inside(range);
#endif
    vec3 first = curve_at(range.x);
    vec3 way = nearest_turn(first, curve_at(range.y)) - first;
    set_metres(way, (range.y - range.x) * metres_of_view());
#ifdef FADE
    fade_curve(way);
    vec2 faded = falling_range(begin);
    range = vec2(max(range.x, faded.x), min(range.y, faded.y));
#endif
#ifdef BEAMS
    range.x = max(range.x, clear_part(dot(view_way, view_forward.xyz)));
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
