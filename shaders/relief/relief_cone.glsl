// Cone stepping (Dummer 2006): each step goes to the end of the cone below the ray. In a relaxed cone
// (Policarpo and Oliveira 2007) a falling ray meets the surface at most once, so a step may end below the
// surface, and the hit lies in that step.
#ifdef TILE
layout(binding = cone_map_unit) uniform sampler2D cone_map;
uniform ivec2 last_cell;
#elif defined(STREAMED)
layout(binding = relief_cone_map_unit) uniform sampler2DArray cone_maps; // cells of a tile per metre
#else
layout(binding = relief_cone_map_unit) uniform sampler2D cone_map;
#endif

// Plain and relaxed cone, samples per unit of height.
vec2 cones_at(vec2 place) {
    count_taps(1.0);
#ifdef TILE
    vec2 cell = floor(place);
#ifdef WRAP
    vec2 cells = vec2(last_cell + 1);
    cell -= cells * floor(cell / cells);
#endif
    return texelFetch(cone_map, clamp(ivec2(cell), ivec2(0), last_cell), 0).rg;
#elif defined(STREAMED)
    ivec2 cell = cell_at(place);
    StreamedTile tile = tile_of_page(page_of(cell).x);
    TileCell found = tile_cell(cell, tile.level);
    vec2 cones = texelFetch(cone_maps, ivec3(found.index, int(tile.layer)), 0).rg;
    return cones * (height_span.y * min(found.extent.x, found.extent.y));
#else
    return texelFetch(cone_map, ivec2(floor(place)) + origin_cell, 0).rg;
#endif
}

// The last part to which the cone of a place holds.
#ifdef STREAMED
// Cones know their own tile only, and other pages may show other tiles. They take all cells for equal, but the
// terrain's end may cut the last ones. Steps a little into the next page.
float end_of_cone(vec3 start, vec3 span, float at) {
    const float beyond = 1.0 / 1024.0; // cells
    ivec2 cell = cell_at(start.xy + at * span.xy);
    int level = tile_of_page(page_of(cell).x).level;
    vec2 low = vec2(((cell >> page_level) << page_level) - origin_cell);
    vec2 high = low + float(page_cells);
    vec2 cut = low + floor((box_end.xy - low) / float(1 << level)) * float(1 << level);
    vec2 here = start.xy + at * span.xy;
    bvec2 in_cut = greaterThanEqual(here, cut);
    low = mix(low, cut, in_cut);
    high = mix(min(high, cut), high, in_cut);
    vec2 border = mix(low, high, greaterThan(span.xy, vec2(0.0)));
    vec2 still = vec2(equal(span.xy, vec2(0.0)));
    vec2 ends = (abs(border - start.xy) + beyond) / (abs(span.xy) + still) + 2.0 * still;
    return min(ends.x, ends.y);
}
#else
float end_of_cone(vec3 start, vec3 span, float at) {
    return 3.0; // beyond the ray
}
#endif

// Bisection, then a secant, between `part` at clearance `over` (>= 0) and `low_part` at `under` (< 0).
float halved(vec3 start, vec3 span, float part, float over, float low_part, float under) {
    for (float i = 0.0; i < bisection_steps; ++i) {
        count_step();
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

#ifndef TILE
// The true first hit behind a part: a terrain has no holes where cones run out or skip a crest.
bool find_rest(vec3 start, vec3 span, float from, out float part, out vec2 place) {
    bool began_above = begins_above;
    begins_above = began_above || from > 0.0;
    bool found = find_exact_hit(start + from * span, (1.0 - from) * span, part, place);
    begins_above = began_above;
    part = mix(from, 1.0, part);
    return found;
}
#endif

#ifdef CURVED
// Of all chords of a ray: some drivers end loops after 65,536 turns.
float cone_steps_left = 8192.0;
#endif

bool find_hit(vec3 start, vec3 span, out float part, out vec2 place) {
    const float steps_below = 64.0; // per ray, until it leaves the surface
    bool relaxed = cone_relaxed > 0.5 && span.z <= 0.0;
    float n = cone_max_steps;
#ifdef CURVED
    n = min(n, cone_steps_left);
#endif
    float run = length(span.xy);
    float min_way = run > cone_min_step ? cone_min_step / run : 1.0;
    float at = 0.0;
    float over = start.z - height_at(start.xy);
#ifndef TILE
    if (over < 0.0) { // from below, cones say nothing
        return find_rest(start, span, 0.0, part, place);
    }
#endif
    float next = 0.0;
    float under = 0.0;
    bool found = false;
    bool skips = false; // any place
#ifndef TILE
    const float certain_over = 1.0 / 4096.0; // above what texture filters round
    float certain = 0.0;                     // the last part so far above the surface
#endif
    float steps = 0.0;
    for (; steps < n && next < 1.0; ++steps) {
        count_step();
        vec2 cones = cones_at(start.xy + at * span.xy);
        float ratio = relaxed ? cones.g : cones.r;
        float opens = run - ratio * span.z;
        float way = opens > 0.0 ? max(ratio * over / opens, min_way) : 1.0;
        skips = skips || over < 0.0 || ratio * over < min_way * opens;
        way = over >= 0.0 ? min(way, end_of_cone(start, span, at) - at) : 1.0 / steps_below;
        next = min(at + way, 1.0);
        vec3 p = start + next * span;
        float now = p.z - height_at(p.xy);
        if (now < 0.0 && over >= 0.0) {
            under = now;
            found = true;
            break;
        }
        at = next;
        over = now;
#ifndef TILE
        certain = over > certain_over ? at : certain;
#endif
    }
#ifdef CURVED
    cone_steps_left -= steps;
#endif
    part = found ? halved(start, span, at, over, next, under) : at;
    place = start.xy + part * span.xy;
#ifdef TILE
    // The steps also run out close to the surface.
    found = found || (at < 1.0 && over >= 0.0 && span.z < 0.0);
#else
    ends_above = true;
    if (!found && (skips || at < 1.0 || over <= certain_over)) {
        found = find_rest(start, span, skips ? 0.0 : certain, part, place);
    }
#endif
    return found;
}
