// Chords that a ray is seen beside by less than its tolerance. Meridians converge, so they are short near the axis.
struct Chords {
    float first; // part
    float last;
    float wider; // than the tolerance
    int count;
};

// `share`: of the number that keeps the error.
Chords chords_between(vec2 range, float share) {
    const int max_chords = 4096;
    return Chords(range.x, range.y, 1.0 / (share * share), max_chords);
}

float first_end(Chords chords) {
    return chords.first;
}

// A straight way is curved in degrees: by 2 / radius at most through its height, and along the ground by 1.16 times the
// tangent of the latitude over the radius. Between distances a and b it is seen beside a chord by at most
// (sqrt(b) - sqrt(a))^2 / 2 of the curvature.
float end_of_chord(Chords chords, int i, float before) {
    const float least_radius = 6.3e6; // metres
    EarthPlace here = earth_place_at(before);
    float metres = length(curve.way);
    float distance_to_begin = before * metres;
    vec2 tolerance = curve.tolerance * chords.wider;
    float upward = dot(here.up, curve.way) / metres;
    float along_ground = max(1.0 - upward * upward, 1e-6);
    float unseen = tolerance.x * distance_to_begin + tolerance.y;
    float from_axis = max(0.5 * here.from_axis, unseen);
    float bend = 2.0 / least_radius + 1.16 * along_ground * abs(here.up.z) / from_axis;
    float root = sqrt(distance_to_begin) + sqrt(2.0 * tolerance.x / bend);
    float end = tolerance.x > 0.0 ? root * root : distance_to_begin + sqrt(8.0 * tolerance.y / bend);
    end = min(end, distance_to_begin + from_axis * inversesqrt(along_ground)); // half of the way to the axis
    return min(max(end / metres, before * (1.0 + 1e-6)), chords.last);
}

vec3 place_of_end(Chords chords, float part) {
    return curve_at(part);
}

#ifdef FADE
void fade_curve(vec3 span) {
    float share = share_of_heights(span);
    curve.eye.z = fade_reference_height + (curve.eye.z - fade_reference_height) / share;
    curve.rise /= share;
}
#endif

// As in polynomial_search.glsl: heights along a ray are convex.
float falling_to(float height, float begin) {
    const int max_steps = 8;
    float part = begin;
    for (int i = 0; i < max_steps && part <= 1.0; ++i) {
        float over = curve_at(part).z - height;
        if (over <= 0.0) {
            break;
        }
        float slope = curve_slope_at(part).z;
        part = slope < 0.0 ? part - over / slope : 2.0;
    }
    return part;
}

float rising_to(float height, float end) {
    const int max_steps = 8;
    float part = end;
    for (int i = 0; i < max_steps; ++i) {
        float over = curve_at(part).z - height;
        float slope = curve_slope_at(part).z;
        part -= over > 0.0 && slope > 0.0 ? over / slope : 0.0;
    }
    return part;
}

// The part nearest to the Earth's centre, or where the ray reaches a depth below all ground.
float deepest_part() {
    const float square_at_depth = 0.96;
    vec3 shrinking = 1.0 / degree_earth.xxy;
    float along_axis = (degree_earth.y + degree_earth.z * degree_eye.y) * degree_circle.y;
    vec3 from = (vec3(degree_eye.x, 0.0, along_axis) + curve.begin) * shrinking;
    vec3 way = curve.way * shrinking;
    float square = dot(way, way);
    float nearest = -dot(from, way) / square;
    vec3 there = from + nearest * way;
    float below = max(square_at_depth - dot(there, there), 0.0);
    return nearest - sqrt(below / square);
}

vec2 falling_range(float begin) {
    float first = falling_to(curve.high.z, begin);
    float deepest = clamp(deepest_part(), begin, 1.0);
    float over = curve_at(first).z - curve.low.z;
    float under = curve_at(deepest).z - curve.low.z;
    if (!(over > 0.0 && under < 0.0 && deepest > first)) {
        return vec2(first, rising_to(curve.high.z, 1.0));
    }
    float last = deepest;
    for (int i = 0; i < 4; ++i) { // by secants: they lie above
        last = mix(first, last, over / (over - under));
        under = min(curve_at(last).z - curve.low.z, 0.0);
    }
    return vec2(first, last);
}
