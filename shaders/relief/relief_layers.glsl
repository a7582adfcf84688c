// Equal steps until one lies in a solid or crosses one; then bisection of the entry, then a secant (GPU
// surface-detail survey 2008 ch. 3.6.9-11; Policarpo and Oliveira 2006).

vec2 middles_of(vec4 layers) {
    return 0.5 * (layers.xz + layers.yw);
}

float depth_at(vec3 point) {
    return depth_between(layers_at(point.xy), point.z);
}

// The part at which the ray passes the middle of a solid; `solid`: 0 upper, 1 lower.
float middle_part(vec3 start, vec3 span, float low, float high, int solid) {
    vec3 first = start + low * span;
    bool over = first.z > middles_of(layers_at(first.xy))[solid];
    for (float i = 0.0; i < bisection_steps; ++i) {
        float middle = 0.5 * (low + high);
        vec3 p = start + middle * span;
        bool same = (p.z > middles_of(layers_at(p.xy))[solid]) == over;
        low = same ? middle : low;
        high = same ? high : middle;
    }
    return 0.5 * (low + high);
}

// A part of the step inside a solid that it crosses; 2 if none.
float part_within(vec3 start, vec3 span, float low, float high, vec2 over, vec2 now) {
    float within = 2.0;
    for (int solid = 0; solid < 2; ++solid) {
        if (over[solid] * now[solid] < 0.0) {
            float part = middle_part(start, span, low, high, solid);
            within = depth_at(start + part * span) > 0.0 ? min(within, part) : within;
        }
    }
    return within;
}

// Between `part`, outside, and `inner`, inside. Sets hit_layer.
float entry_part(vec3 start, vec3 span, float part, float inner) {
    for (float i = 0.0; i < bisection_steps; ++i) {
        float middle = 0.5 * (part + inner);
        bool inside = depth_at(start + middle * span) > 0.0;
        inner = inside ? middle : inner;
        part = inside ? part : middle;
    }
    vec3 outer_point = start + part * span;
    vec3 inner_point = start + inner * span;
    vec4 outer_layers = layers_at(outer_point.xy);
    vec4 inner_layers = layers_at(inner_point.xy);
    vec2 depths = min(inner_layers.xz - inner_point.z, inner_point.z - inner_layers.yw);
    int solid = depths.x > depths.y ? 0 : 1;
    bool from_above = outer_point.z > middles_of(outer_layers)[solid];
    hit_layer = 2 * solid + (from_above ? 0 : 1);
    float out_by = max(outer_point.z - outer_layers[2 * solid],
                       outer_layers[2 * solid + 1] - outer_point.z);
    float in_by = depths[solid];
    return mix(part, inner, clamp(out_by / max(out_by + in_by, 1e-30), 0.0, 1.0));
}

bool find_hit(vec3 start, vec3 span, out float part, out vec2 place) {
    float n = linear_steps;
    vec4 layers = layers_at(start.xy);
    vec2 over = start.z - middles_of(layers);
    bool outside = depth_between(layers, start.z) <= 0.0;
    float at = 0.0;
    float inner = 2.0;
    for (float i = 1.0; i <= n && inner > 1.0; ++i) {
        float next = i / n;
        vec3 p = start + next * span;
        layers = layers_at(p.xy);
        vec2 now = p.z - middles_of(layers);
        bool inside = depth_between(layers, p.z) > 0.0;
        if (outside) {
            inner = inside ? next : part_within(start, span, at, next, over, now);
        }
        at = inner > 1.0 ? next : at;
        over = now;
        outside = !inside;
    }
    bool found = inner <= 1.0;
    part = found ? entry_part(start, span, at, inner) : 1.0;
    place = start.xy + part * span.xy;
    return found;
}
