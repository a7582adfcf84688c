float first_part_of_view() {
    return perspective > 0.5 ? clamp(near_depth / dot(view_way, view_forward.xyz), 0.0, 1.0) : 0.0;
}

// Chords that a ray is seen beside by less than its tolerance. Meridians converge, so they are short near the axis.
struct Chords {
    float first; // part
    float last;
    float tolerance; // a factor of the curve's
    int count;
    EarthPlace here; // at the last end
};

// `share`: of the number that keeps the error.
Chords chords_between(vec2 range, float share) {
    const int max_chords = 4096;
    return Chords(range.x, range.y, 1.0 / (share * share), max_chords, earth_place_at(range.x));
}

float first_end(Chords chords) {
    return chords.first;
}

vec3 place_on_curve(inout Chords chords, float part) {
    chords.here = earth_place_at(part);
    return sample_of(chords.here);
}

vec3 place_of_end(inout Chords chords, float part) {
    return place_on_curve(chords, part);
}

// A straight way is curved in degrees: by 2 / radius at most through its height. Along the ground by 1.16 times the
// tangent of the latitude over the radius; and if it passes the axis at a distance of p, by 2 p / d^2 at a distance of d.
// Between distances a and b from the begin it is seen beside a chord by at most (sqrt(b) - sqrt(a))^2 / 2 of the
// curvature.
float end_of_chord(Chords chords, int i, float before) {
    const float min_radius = 6.3e6;    // metres
    const float min_distance = 0.0001; // metres, from the axis: of the closest samples on the Earth
    float metres = length(curve.way);
    float from_begin = before * metres;
    vec2 tolerance = curve.tolerance * chords.tolerance;
    float upward = dot(chords.here.up, curve.way) / metres;
    float along_ground = max(1.0 - upward * upward, 1e-6);
    float unseen = max(tolerance.x * from_begin + tolerance.y, min_distance);
    float from_axis = max(0.5 * chords.here.from_axis, unseen);
    vec2 aside = chords.here.aside;
    float passes = abs(aside.x * curve.way.y - aside.y * curve.way.x) / metres;
    float turning = min(1.16 * along_ground / from_axis, 2.0 * passes / (from_axis * from_axis));
    float bend = 2.0 / min_radius + abs(chords.here.up.z) * turning;
    float root = sqrt(from_begin) + sqrt(2.0 * tolerance.x / bend);
    float end = tolerance.x > 0.0 ? root * root : from_begin + sqrt(8.0 * tolerance.y / bend);
    end = min(end, from_begin + from_axis * inversesqrt(along_ground)); // half of the way to the axis
    return i == chords.count ? chords.last : min(max(end / metres, before * (1.0 + 1e-6)), chords.last);
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
        EarthPlace at = earth_place_at(part);
        float over = sample_of(at).z - height;
        if (over <= 0.0) {
            break;
        }
        float slope = slope_of(at).z;
        part = slope < 0.0 ? part - over / slope : 2.0;
    }
    return part;
}

float rising_to(float height, float end) {
    const int max_steps = 8;
    float part = end;
    for (int i = 0; i < max_steps; ++i) {
        EarthPlace at = earth_place_at(part);
        float over = sample_of(at).z - height;
        float slope = slope_of(at).z;
        if (over <= 0.0 || slope <= 0.0) {
            break;
        }
        part -= over / slope;
    }
    return part;
}

// The part nearest to the Earth's centre, or where the ray reaches a depth below all ground.
float deepest_part() {
    const float square_at_depth = 0.96; // of the share of the radius: 2 % below, 127 km
    vec3 shrinking = 1.0 / degree_earth.xxy;
    vec3 from = (eye_from_center() + curve.begin) * shrinking;
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
