float first_part_of_view() {
    return clamp(near_depth / dot(view_way, view_forward.xyz), 0.0, 1.0);
}

// Chords of equal length in the square root of the part are seen from part 0 beside the curve by equal angles
// (view/rays/ray_course.h). Their ends lie beyond the curve by half of that, so that their middles do not.
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

float first_end(Chords chords) {
    return chords.first * chords.first;
}

vec3 place_on_curve(inout Chords chords, float part) {
    return curve_at(part);
}

float end_of_chord(Chords chords, int i, float before) {
    float root = chords.first + float(i) * chords.stride;
    return root * root;
}

vec3 place_of_end(inout Chords chords, float part) {
    return curve_at(part) - 0.25 * chords.stride * chords.stride * part * curve_bend_at(part);
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
