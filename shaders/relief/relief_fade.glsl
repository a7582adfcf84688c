// Reduces heights at grazing angles (GPU surface-detail survey 2008 ch. 3.6.4): low + (high - low)(1 -
// (1 - cos a)^power) of them remains, around the reference height. Implemented by stretching the ray in z.
float share_of_heights(vec3 span) {
    const float flattest = 1.0 / 4096.0; // the margin of the box
    float share = 1.0 - pow(1.0 - uprightness(span), fade_power);
    return max(mix(fade_low, fade_high, share), flattest);
}

// Stretches a ray and clips it to two heights. Returns the remaining parts.
vec2 stretch(float low, float high, inout vec3 start, inout vec3 span) {
    float share = share_of_heights(span);
    float begin_height = fade_reference_height + (start.z - fade_reference_height) / share;
    float rise = span.z / share;
    vec2 ends = vec2(0.0, 1.0);
    if (rise != 0.0) {
        vec2 reached = (vec2(low, high) - begin_height) / rise;
        ends = clamp(vec2(min(reached.x, reached.y), max(reached.x, reached.y)), 0.0, 1.0);
    }
    start = vec3(start.xy + ends.x * span.xy, begin_height + ends.x * rise);
    span = (ends.y - ends.x) * vec3(span.xy, rise);
    return ends;
}
