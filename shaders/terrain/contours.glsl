// Lines of equal height, as packets of rays paint them (packet_contours-inl.h).

// `height`: true metres; `change`: its change from a pixel to its neighbours, metres.
vec3 with_contours(vec3 lit, float height, float change) {
    const float bold_every = 5.0;
    const float flattest = 1.0 / 65536.0; // intervals a pixel
    float interval = contours.x;
    if (interval <= 0.0 || change < flattest * interval) {
        return lit;
    }
    float number = round(height / interval);
    float pixels = abs(height - number * interval) / change;
    bool is_bold = mod(number, bold_every) == 0.0;
    float apart = interval / change * (is_bold ? bold_every : 1.0);
    float ink = clamp((is_bold ? 1.3 : 1.0) - pixels, 0.0, 1.0) * smoothstep(3.0, 8.0, apart);
    return lit * (1.0 - ink * (is_bold ? 0.6 : 0.4));
}
