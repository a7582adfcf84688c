// View rays over the curved Earth: in the search space they are polynomials of degree 4 in their part.
layout(std140, binding = course_block_binding) uniform CourseBlock {
#include "frame/course_block.inc"
};

struct Curve {
    vec3 eye;
    vec3 terms[4]; // of the powers 1 to 4 of the part
};

// Of this fragment's ray.
Curve curve = Curve(vec3(0.0), vec3[4](vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0)));

vec3 curve_at(float part) {
    return curve.eye +
           part * (curve.terms[0] +
                   part * (curve.terms[1] + part * (curve.terms[2] + part * curve.terms[3])));
}

vec3 curve_slope_at(float part) {
    return curve.terms[0] +
           part * (2.0 * curve.terms[1] +
                   part * (3.0 * curve.terms[2] + part * 4.0 * curve.terms[3]));
}

// Monomials: by degree, then falling powers of x, then of y.
#define TERM(n) course_terms[n].xyz
Curve curve_along(vec3 relative) {
    vec3 d = mat3(unit_from_relative) * relative;
    float xx = d.x * d.x;
    float xy = d.x * d.y;
    float xz = d.x * d.z;
    float yy = d.y * d.y;
    float yz = d.y * d.z;
    float zz = d.z * d.z;
    vec3 second[6] = vec3[6](TERM(3), TERM(4), TERM(5), TERM(6), TERM(7), TERM(8));
    Curve found;
    found.eye = course_eye.xyz;
    found.terms[0] = d.x * TERM(0) + d.y * TERM(1) + d.z * TERM(2);
    found.terms[1] = xx * second[0] + xy * second[1] + xz * second[2] + yy * second[3] +
                     yz * second[4] + zz * second[5];
    found.terms[2] =
        xx * (d.x * TERM(9) + d.y * TERM(10) + d.z * TERM(11)) +
        d.x * (yy * TERM(12) + yz * TERM(13) + zz * TERM(14)) +
        yy * (d.y * TERM(15) + d.z * TERM(16)) + zz * (d.y * TERM(17) + d.z * TERM(18));
    found.terms[3] =
        xx * (xx * TERM(19) + xy * TERM(20) + xz * TERM(21) + yy * TERM(22) + yz * TERM(23) +
              zz * TERM(24)) +
        xy * (yy * TERM(25) + yz * TERM(26) + zz * TERM(27)) + xz * zz * TERM(28) +
        yy * (yy * TERM(29) + yz * TERM(30) + zz * TERM(31)) + zz * (yz * TERM(32) + zz * TERM(33));
    return found;
}
#undef TERM

vec3 curve_bend_at(float part) {
    return 2.0 * curve.terms[1] + part * (6.0 * curve.terms[2] + part * 12.0 * curve.terms[3]);
}

// Chords of equal length in the square root of the distance are seen beside the curve by equal angles
// (view/ray_course.h). Their ends lie beyond the curve by half of that, so that their middles do not.
struct Chords {
    float first; // square root of the part
    float stride;
    float count;
};

// `share`: of the number that keeps the error.
Chords chords_between(vec2 range, float metres, float share) {
    float first = sqrt(range.x);
    float way = max(sqrt(range.y) - first, 0.0);
    float count = max(ceil(way * sqrt(metres) * share * course_eye.w), 1.0);
    return Chords(first, way / count, count);
}

float end_of_chord(Chords chords, float i) {
    float root = chords.first + i * chords.stride;
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
        float over = curve_at(range.x).z - course_end.z;
        float slope = curve_slope_at(range.x).z;
        if (over > 0.0) {
            range.x = slope < 0.0 ? range.x - over / slope : 2.0;
        }
    }
    for (int i = 0; i < 3; ++i) {
        float over = curve_at(range.y).z - course_end.z;
        float slope = curve_slope_at(range.y).z;
        range.y -= over > 0.0 && slope > 0.0 ? over / slope : 0.0;
    }
    for (int i = 0; i < 2; ++i) {
        float over = curve_at(range.x).z - course_begin.z;
        float under = curve_at(range.y).z - course_begin.z;
        if (over > 0.0 && under < 0.0) {
            range.y = mix(range.x, range.y, over / (over - under));
        }
    }
    return range;
}

// The parts of a chord in the visible search space; the second is smaller if there are none.
vec2 parts_inside(vec3 start, vec3 span) {
    vec3 still = vec3(equal(span, vec3(0.0)));
    vec3 inverse = 1.0 / (span + still * 1e-30); // a border away from it: infinitely far
    vec3 low = (course_begin.xyz - start) * inverse;
    vec3 high = (course_end.xyz - start) * inverse;
    vec3 first = min(low, high);
    vec3 last = max(low, high);
    return vec2(max(max(first.x, first.y), max(first.z, 0.0)),
                min(min(last.x, last.y), min(last.z, 1.0)));
}

// The parts of the ray between which it is in the visible search space.
vec2 range_inside(Chords chords) {
    vec2 range = vec2(2.0, 0.0);
    float before = chords.first * chords.first;
    vec3 start = curve_at(before);
    for (float i = 1.0; i <= chords.count; ++i) {
        float next = end_of_chord(chords, i);
        vec3 end = curve_at(next);
        vec2 inside = parts_inside(start, end - start);
        if (inside.x <= inside.y) {
            range = vec2(min(range.x, mix(before, next, inside.x)), mix(before, next, inside.y));
        } else if (range.x <= 1.0) {
            break;
        }
        before = next;
        start = end;
    }
    return range;
}
