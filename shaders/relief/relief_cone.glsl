// Cone stepping (Dummer 2006): each step goes to the end of the cone below the ray. In a relaxed cone
// (Policarpo and Oliveira 2007) a falling ray meets the surface at most once, so a step may end below the
// surface, and the hit lies in that step.
#ifdef TILE
layout(binding = cone_map_unit) uniform sampler2D cone_map;
uniform ivec2 last_cell;
#else
layout(binding = relief_cone_map_unit) uniform sampler2D cone_map;
#endif

// Plain and relaxed cone, samples per unit of height.
vec2 cones_at(vec2 place) {
#ifdef TILE
    vec2 cell = floor(place);
#ifdef WRAP
    vec2 cells = vec2(last_cell + 1);
    cell -= cells * floor(cell / cells);
#endif
    return texelFetch(cone_map, clamp(ivec2(cell), ivec2(0), last_cell), 0).rg;
#else
    return texelFetch(cone_map, ivec2(place), 0).rg;
#endif
}

// Bisection, then a secant, between `part` at clearance `over` (>= 0) and `low_part` at `under` (< 0).
float halved(vec3 start, vec3 span, float part, float over, float low_part, float under) {
    for (float i = 0.0; i < bisection_steps; ++i) {
        float middle = 0.5 * (part + low_part);
        vec3 p = start + middle * span;
        float above = p.z - height_at(p.xy);
        if (above < 0.0) {
            low_part = middle;
            under = above;
        } else {
            part = middle;
            over = above;
        }
    }
    return mix(part, low_part, over / (over - under));
}

bool find_hit(vec3 start, vec3 span, out float part, out vec2 place) {
    const float steps_below = 64.0; // per ray, until it leaves the surface
    bool relaxed = cone_relaxed > 0.5 && span.z <= 0.0;
    float n = cone_max_steps;
    float run = length(span.xy);
    float min_way = run > cone_min_step ? cone_min_step / run : 1.0;
    float at = 0.0;
    float over = start.z - height_at(start.xy);
    float next = 0.0;
    float under = 0.0;
    bool found = false;
    for (float i = 0.0; i < n && next < 1.0; ++i) {
        vec2 cones = cones_at(start.xy + at * span.xy);
        float ratio = relaxed ? cones.g : cones.r;
        float opens = run - ratio * span.z;
        float way = opens > 0.0 ? max(ratio * over / opens, min_way) : 1.0;
        next = min(at + (over >= 0.0 ? way : 1.0 / steps_below), 1.0);
        vec3 p = start + next * span;
        float now = p.z - height_at(p.xy);
        if (now < 0.0 && over >= 0.0) {
            under = now;
            found = true;
            break;
        }
        at = next;
        over = now;
    }
    part = found ? halved(start, span, at, over, next, under) : at;
    place = start.xy + part * span.xy;
    // The steps also run out close to the surface.
    return found || (at < 1.0 && over >= 0.0 && span.z < 0.0);
}
