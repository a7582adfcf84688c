// Polynomials of degree 4 in the part of a ray. View rays have the terms of degree 4 with QUARTIC only.
struct Curve {
    vec3 eye;
    vec3 terms[4]; // of the powers 1 to 4 of the part
    vec3 low;      // of the part of the search space that is searched
    vec3 high;
    float chords; // at part 1
};

// Of this fragment's ray.
Curve curve = Curve(vec3(0.0), vec3[4](vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0)), vec3(0.0), vec3(0.0), 1.0);

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

vec3 curve_bend_at(float part) {
    return 2.0 * curve.terms[1] + part * (6.0 * curve.terms[2] + part * 12.0 * curve.terms[3]);
}

struct Monomials {
    vec3 d;
    vec3 x; // times x, y, z
    vec3 y;
    vec3 z;
};

Monomials monomials_of(vec3 relative) {
    vec3 d = mat3(unit_from_relative) * relative;
    return Monomials(d, d.x * d, d.y * d, d.z * d);
}

// Sums of the terms of a degree, by falling powers of x, then of y.
#define SUM_OF_3(t, n, d) (d.x * t[n].xyz + d.y * t[n + 1].xyz + d.z * t[n + 2].xyz)
#define FIRST_DEGREE(t, n, m) SUM_OF_3(t, n, m.d)
#define SECOND_DEGREE(t, n, m) \
    (SUM_OF_3(t, n, m.x) + m.y.y * t[n + 3].xyz + m.y.z * t[n + 4].xyz + m.z.z * t[n + 5].xyz)
#define THIRD_DEGREE(t, n, m) \
    (m.x.x * SUM_OF_3(t, n, m.d) + \
     m.d.x * (m.y.y * t[n + 3].xyz + m.y.z * t[n + 4].xyz + m.z.z * t[n + 5].xyz) + \
     m.y.y * (m.d.y * t[n + 6].xyz + m.d.z * t[n + 7].xyz) + \
     m.z.z * (m.d.y * t[n + 8].xyz + m.d.z * t[n + 9].xyz))
#define FOURTH_DEGREE(t, n, m) \
    (m.x.x * SECOND_DEGREE(t, n, m) + \
     m.x.y * (m.y.y * t[n + 6].xyz + m.y.z * t[n + 7].xyz + m.z.z * t[n + 8].xyz) + \
     m.x.z * m.z.z * t[n + 9].xyz + \
     m.y.y * (m.y.y * t[n + 10].xyz + m.y.z * t[n + 11].xyz + m.z.z * t[n + 12].xyz) + \
     m.z.z * (m.y.z * t[n + 13].xyz + m.z.z * t[n + 14].xyz))

// Polynomials are continuous.
vec2 within_half_turn(vec2 way) {
    return way;
}

vec3 nearest_turn(vec3 start, vec3 end) {
    return end;
}

float turns_behind(vec3 end) {
    return 0.0;
}

vec3 turned(vec3 place, float turns) {
    return place;
}

vec2 within_turn(vec2 place) {
    return place;
}

// Of this fragment's view ray: where it leaves the box, relative to the eye.
vec3 view_way = vec3(0.0);

vec3 on_view_ray(float part) {
    return part * view_way;
}

float metres_of_view() {
    return length(view_way);
}

// `relative`: its end, relative to the eye.
Curve view_curve(vec3 relative) {
    view_way = relative;
    Monomials m = monomials_of(relative);
    vec3 terms[4] = vec3[4](FIRST_DEGREE(course_terms, 0, m), SECOND_DEGREE(course_terms, 3, m),
                            THIRD_DEGREE(course_terms, 9, m),
#ifdef QUARTIC
                            FOURTH_DEGREE(course_terms, 19, m));
#else
                            vec3(0.0));
#endif
    return Curve(course_eye.xyz, terms, course_begin.xyz, course_end.xyz,
                 sqrt(length(relative)) * course_eye.w);
}
