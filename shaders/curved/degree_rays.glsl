// Over terrain that is even in degrees: places of a ray are mapped one by one, in differences from the eye
// (view/rays/degree_course.h). Axes: away from that of the Earth at the eye's meridian, east, and north along it.
struct Curve {
    vec3 eye;       // the sample from which places differ
    vec3 begin;     // of the ray, from the eye, metres along the axes
    vec3 way;       // to its end
    vec3 low;       // of the part of the search space that is searched
    vec3 high;
    float rise;     // units of height in a metre
    vec2 tolerance; // of chords: radians seen from the begin; metres
};

// Of this fragment's ray.
Curve curve = Curve(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), 1.0, vec2(1.0));

const float pi = 3.14159265358979;

// Of a vector, with errors of a few units of 2^-24 (polynomial: Moshier, Cephes, atanf).
float angle_of(float y, float x) {
    float longer = max(abs(x), abs(y));
    float t = min(abs(x), abs(y)) / max(longer, 1e-37);
    const float tan_of_eighth = 0.414213562;
    bool beyond = t > tan_of_eighth;
    float r = beyond ? (t - 1.0) / (t + 1.0) : t;
    float z = r * r;
    float angle = (((8.05374449538e-2 * z - 1.38776856032e-1) * z + 1.99777106478e-1) * z -
                   3.33329491539e-1) * z * r + r;
    angle += beyond ? 0.25 * pi : 0.0;
    angle = abs(y) > abs(x) ? 0.5 * pi - angle : angle;
    angle = x < 0.0 ? pi - angle : angle;
    return y < 0.0 ? -angle : angle;
}

// Seen from the eye.
struct EarthPlace {
    vec3 shift; // of the sample: with even rows
    vec3 up;    // unit vector
    float to_center; // of the meridian's curvature, metres
    float from_axis; // metres
    vec2 aside; // from the axis
};

// `rise`: units of height in a metre.
EarthPlace earth_place(vec3 way, float rise) {
    vec2 earth = degree_earth.xy;
    vec2 flattened = vec2(1.0, degree_earth.z);
    vec2 circle = degree_circle.xy;
    float eye_from_axis = degree_eye.x;
    float lift_of_eye = degree_eye.y;
    vec2 aside = vec2(eye_from_axis + way.x, way.y);
    float from_axis = length(aside);
    vec2 shift = vec2((way.x * (eye_from_axis + aside.x) + way.y * way.y) / max(from_axis + eye_from_axis, 1e-30),
                      way.z); // from and along the axis
    float lift = degree_eye.z;
    for (int i = 0; i < 3; ++i) {
        vec2 radii = earth + flattened * (lift_of_eye + lift);
        vec2 change = (shift - circle * flattened * lift) / radii;
        vec2 at = circle + change;
        lift += dot(2.0 * circle + change, change) / (2.0 * dot(at * at, flattened / radii));
    }
    vec2 change = (shift - circle * flattened * lift) / (earth + flattened * (lift_of_eye + lift));
    vec2 normal_of_eye = circle * flattened;
    vec2 normal_change = flattened * change;
    vec2 normal = normal_of_eye + normal_change;
    float size = length(normal);
    float size_change = dot(2.0 * normal_of_eye + normal_change, normal_change) / (size + length(normal_of_eye));
    float latitude = angle_of(normal_of_eye.x * normal_change.y - normal_of_eye.y * normal_change.x,
                              dot(normal_of_eye, normal));
    float longitude = angle_of(aside.y, aside.x);
    longitude -= 2.0 * pi * floor((longitude - degree_circle.z) / (2.0 * pi));
    vec2 moved = degree_samples.xy * latitude + degree_samples.zw * longitude;
    vec2 upward = normal / size;
    float meridian = earth.y * earth.y / earth.x * size * size * size; // its radius of curvature
    return EarthPlace(vec3(moved, (lift * size + lift_of_eye * size_change) * rise),
                      vec3(upward.x * aside / max(from_axis, 1e-30), upward.y),
                      meridian + (lift_of_eye + lift) * size, from_axis, aside);
}

EarthPlace earth_place_at(float part) {
    return earth_place(curve.begin + part * curve.way, curve.rise);
}

// Rows of a way of even rows from the eye. Rows that close the terrain at a pole are nearer to the others: before one row
// and after another, both counted from the eye.
float rows_of(float even) {
    vec4 longer = degree_rows;
    float before = longer.x > 0.0 ? min(even, longer.x) : min(even - longer.x, 0.0);
    float after = longer.z < 0.0 ? max(even, longer.z) : max(even - longer.z, 0.0);
    return even + longer.y * before + longer.w * after;
}

float rows_in_even_row(float even) {
    return 1.0 + (even < degree_rows.x ? degree_rows.y : 0.0) + (even > degree_rows.z ? degree_rows.w : 0.0);
}

vec3 moved_by(EarthPlace at) {
    return vec3(at.shift.x, rows_of(at.shift.y), at.shift.z);
}

vec3 sample_of(EarthPlace at) {
    return curve.eye + moved_by(at);
}

vec3 curve_at(float part) {
    return sample_of(earth_place_at(part));
}

vec3 slope_of(EarthPlace at) {
    vec2 outward = at.aside / max(at.from_axis, 1e-30);
    vec3 north = vec3(-at.up.z * outward, length(at.up.xy));
    float latitude = dot(north, curve.way) / at.to_center;
    float longitude = (outward.x * curve.way.y - outward.y * curve.way.x) / max(at.from_axis, 1e-30);
    vec2 moved = degree_samples.xy * latitude + degree_samples.zw * longitude;
    return vec3(moved.x, moved.y * rows_in_even_row(at.shift.y), dot(at.up, curve.way) * curve.rise);
}

vec3 curve_slope_at(float part) {
    return slope_of(earth_place_at(part));
}

// Radians east in a way between samples.
float longitude_of(vec2 way) {
    vec4 a_radian = degree_samples;
    return (a_radian.x * way.y - a_radian.y * way.x) / (a_radian.x * a_radian.w - a_radian.y * a_radian.z);
}

vec3 turned(vec3 place, float turns) {
    return vec3(place.xy + turns * 2.0 * pi * degree_samples.zw, place.z);
}

// The same way, less than half a turn long.
vec2 within_half_turn(vec2 way) {
    return turned(vec3(way, 0.0), -round(longitude_of(way) / (2.0 * pi))).xy;
}

vec3 nearest_turn(vec3 start, vec3 end) {
    return vec3(start.xy + within_half_turn(end.xy - start.xy), end.z);
}

// From a chord's end beyond the last longitude to the first, and back.
float turns_behind(vec3 end) {
    float east = longitude_of(end.xy - curve.eye.xy) - degree_circle.z;
    return east < 0.0 ? 1.0 : east >= 2.0 * pi ? -1.0 : 0.0;
}

// The same place between the first longitude and the last. Beyond a pole it is half a turn away.
vec2 within_turn(vec2 place) {
    bool is_north = degree_circle.w != 0.0 && degree_circle.w != 2.0 && place.y < box_begin.y;
    bool is_south = degree_circle.w >= 2.0 && place.y > box_end.y;
    if (is_north || is_south) {
        place = vec2(place.x + pi * degree_samples.z, 2.0 * (is_north ? box_begin.y : box_end.y) - place.y);
    }
    vec3 same = vec3(place, 0.0);
    return turned(same, turns_behind(same)).xy;
}

// Of this fragment's view ray, relative to the eye.
vec3 view_begin = vec3(0.0);
vec3 view_way = vec3(0.0);

vec3 on_view_ray(float part) {
    return view_begin + part * view_way;
}

float metres_of_view() {
    return length(view_way);
}

// From the Earth's centre, along the axes.
vec3 eye_from_center() {
    return vec3(degree_eye.x, 0.0, (degree_earth.y + degree_earth.z * degree_eye.y) * degree_circle.y);
}

// Parallel rays begin above the highest ground, so that floats have the digits of the way through heights.
void set_parallel_ray() {
    const float margin = 100.0; // metres: of floats, and of an ellipsoid beside the highest ground
    mat3 axes_from_relative = mat3(unit_from_relative);
    vec2 place = share_of_picture();
    vec3 origin = degree_corner.xyz + place.x * degree_right.xyz + place.y * degree_up.xyz;
    vec3 shrinking = 1.0 / (degree_earth.xxy + degree_earth.w + margin);
    vec3 from = (eye_from_center() + axes_from_relative * origin) * shrinking;
    vec3 way = (axes_from_relative * view_forward.xyz) * shrinking;
    float nearest = -dot(from, way) / dot(way, way);
    vec3 there = from + nearest * way;
    float half_length = sqrt(max(1.0 - dot(there, there), 0.0) / dot(way, way)) + margin;
    view_begin = origin + (nearest - half_length) * view_forward.xyz;
    view_way = 2.0 * half_length * view_forward.xyz;
}

// `back`: where a ray leaves the box, relative to the eye.
Curve view_curve(vec3 back) {
    view_way = back;
    if (perspective < 0.5) {
        set_parallel_ray();
    }
    mat3 axes_from_relative = mat3(unit_from_relative);
    return Curve(course_eye.xyz, axes_from_relative * view_begin, axes_from_relative * view_way, course_begin.xyz,
                 course_end.xyz, degree_eye.w, degree_chords.xy);
}
