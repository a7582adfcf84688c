// Rays to the sun as polynomials.

// From a place of the search space; `relative`: the same place, relative to the eye.
Curve light_curve(vec3 start, vec3 relative) {
    Monomials m = monomials_of(relative);
    vec3 terms[4];
    terms[0] = light_terms[0].xyz + FIRST_DEGREE(light_terms, 1, m) +
               SECOND_DEGREE(light_terms, 4, m) + THIRD_DEGREE(light_terms, 10, m);
    terms[1] = light_terms[20].xyz + FIRST_DEGREE(light_terms, 21, m) +
               SECOND_DEGREE(light_terms, 24, m);
    terms[2] = light_terms[30].xyz + FIRST_DEGREE(light_terms, 31, m);
    terms[3] = light_terms[34].xyz;
    return Curve(start, terms, light_begin.xyz, light_end.xyz, light_end.w);
}

// The part at which the ray is above all heights, at most: by the parabola at its start, then by Newton's method.
float light_end_part() {
    float rise = max(curve.high.z - curve.eye.z, 0.0);
    float slope = curve.terms[0].z;
    float bend = max(curve.terms[1].z, 0.0);
    float end = 2.0 * rise / max(slope + sqrt(slope * slope + 4.0 * bend * rise), 1e-30);
    end = min(end, 1.0);
    for (int i = 0; i < 2; ++i) {
        float over = curve_at(end).z - curve.high.z;
        float steep = curve_slope_at(end).z;
        end = steep > 0.0 ? clamp(end - over / steep, 0.0, 1.0) : end;
    }
    return end;
}
