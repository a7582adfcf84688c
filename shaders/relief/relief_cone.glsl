// From cone to cone (Dummer 2006): as far as the ray stays inside the one that stands below it,
// which holds nothing of the surface. A relaxed cone (Policarpo and Oliveira 2007) holds what a ray
// that does not rise meets at most once: where it is found below the surface, the hit lies behind
// the last place above it.
#ifdef TILE
layout(binding = cone_map_unit) uniform sampler2D cone_map;
uniform ivec2 last_cell;
#else
layout(binding = relief_cone_map_unit) uniform sampler2D cone_map;
#endif

// Of a cell, samples per unit: plain, relaxed.
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

// Between `part` where the ray is `over` (>= 0) above the surface and `low_part` where it is `under`
// (< 0): halved, then the chord.
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
    const float steps_below = 64.0; // from the border on, until the ray comes out
    bool relaxed = cone_relaxed > 0.5 && span.z <= 0.0;
    float n = cone_max_steps;
    float run = length(span.xy);
    float least = run > cone_min_step ? cone_min_step / run : 1.0;
    float at = 0.0;
    float over = start.z - height_at(start.xy);
    float next = 0.0;
    float under = 0.0;
    bool found = false;
    for (float i = 0.0; i < n && next < 1.0; ++i) {
        vec2 cones = cones_at(start.xy + at * span.xy);
        float ratio = relaxed ? cones.g : cones.r;
        float opens = run - ratio * span.z;
        float way = opens > 0.0 ? max(ratio * over / opens, least) : 1.0;
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
    // A falling ray is so near to it that the steps were used up.
    return found || (at < 1.0 && over >= 0.0 && span.z < 0.0);
}
