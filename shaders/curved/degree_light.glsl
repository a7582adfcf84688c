// Rays to the sun, whose places are mapped one by one.

// From a place of the search space; `relative`: the same place, relative to the eye.
Curve light_curve(vec3 start, vec3 relative) {
    mat3 axes_from_relative = mat3(unit_from_relative);
    vec3 begin = axes_from_relative * relative;
    vec3 way = light_begin.w * (axes_from_relative * to_sun.xyz);
    vec3 moved = moved_by(earth_place(begin, degree_eye.w));
    vec3 eye = start - (nearest_turn(start, course_eye.xyz + moved) - course_eye.xyz);
    return Curve(eye, begin, way, light_begin.xyz, light_end.xyz, degree_eye.w, vec2(degree_chords.z, 0.0));
}

// The part at which the ray is above all heights, at most.
float light_end_part() {
    return clamp(rising_to(curve.high.z, 1.0), 0.0, 1.0);
}
