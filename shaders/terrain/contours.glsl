// Lines of equal height.

// By which the true height changes from a pixel to its neighbours in the plane that touches the ground, metres.
float change_of_height(GroundPlace place) {
    float facing = dot(place.normal, place.view);
    facing = facing < 0.0 ? min(facing, -1e-6) : max(facing, 1e-6);
    vec3 rise = place.up - place.normal * (dot(place.up, place.view) / facing);
    return place.pixel * length(rise) / contours.y;
}

// Whether floats do not tell a change of height. Normals of level triangles are rounded: they would rise a little.
bool is_level(float height, float change) {
    return change <= height_rounding * abs(height);
}

// Every fifth line is bold. Crowded lines fade.
vec3 with_contours(vec3 lit, GroundPlace place, float height) {
    float interval = contours.x;
    float change = change_of_height(place);
    if (is_level(height, change)) {
        return lit;
    }
    change *= contours.z;
    float number = round(height / interval);
    float pixels = abs(height - number * interval) / change;
    float fifth = number / bold_every;
    bool is_bold = abs(fifth - round(fifth)) < 0.5 / bold_every;
    float apart = interval / change * (is_bold ? bold_every : 1.0);
    float line = clamp((is_bold ? bold_reach : thin_reach) - pixels, 0.0, 1.0);
    float ink = line * smoothstep(crowded_pixels, apart_pixels, apart);
    return lit * (1.0 - ink * (is_bold ? bold_ink : thin_ink));
}
