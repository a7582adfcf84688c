// The true first hit: traverses a max mipmap (Tevs, Ihrke and Seidel 2008) down to cells, where the bilinear
// surface along the ray is quadratic. The inner loop only descends or advances, with one texel fetch.
#ifdef STREAMED
#include "stream/stream_max.glsl"
#else
layout(binding = max_mipmap_unit) uniform sampler2D max_mipmap; // level 0: maximum of a cell's corners
uniform ivec2 last_cell;
#endif
uniform int top_level;

#ifdef BEAMS
const int start_level = 2; // the ray begins near the surface
#else
const int start_level = 5;
#endif

struct Walk {
    int level;
    ivec2 block;
    float part; // of the ray at the entry
};

// Where a ray leads.
struct Course {
    ivec2 forward;
    vec2 inverse; // of its span
    vec2 never;   // a ray does not leave through borders that are parallel to it
    bool falls;
};

Course course_of(vec3 span) {
    return Course(ivec2(greaterThan(span.xy, vec2(0.0))),
                  vec2(span.x != 0.0 ? 1.0 / span.x : 0.0, span.y != 0.0 ? 1.0 / span.y : 0.0),
                  vec2(span.x != 0.0 ? 0.0 : 2.0, span.y != 0.0 ? 0.0 : 2.0), span.z < 0.0);
}

bool ends_above = true; // the surface: the last ray without a hit

// Whether the walk would not end.
bool is_endless(vec3 start, vec3 span);
ivec2 first_cell(inout vec3 start);
// Parts at which the ray leaves its block through a column's and a row's border.
vec2 exits_of(vec3 start, vec2 inverse, ivec2 forward, Walk walk);
// After a step into the next block: whether it exists.
bool stays(inout vec3 start, inout Walk walk);
float max_height_in(Walk walk);
// A block that exists: the nearest one.
ivec2 existing(ivec2 block, int level);

// A level down, to the block at the entry. Where the ray enters over the last row or column, rounding may put it
// beyond.
void descend(vec3 start, vec3 span, inout Walk walk) {
    --walk.level;
    vec2 middle = vec2(((2 * walk.block + 1) << walk.level) - origin_cell);
    vec2 p = start.xy + walk.part * span.xy;
    walk.block = existing(2 * walk.block + ivec2(greaterThanEqual(p, middle)), walk.level);
}

// Steps into the next block, and a level up at the border of a parent block. False if there is none.
bool move_on(vec2 exits, ivec2 forward, inout vec3 start, inout Walk walk) {
    walk.part = min(exits.x, exits.y);
    bool sideways = exits.x <= exits.y;
    ivec2 stride = 2 * forward - 1;
    walk.block += sideways ? ivec2(stride.x, 0) : ivec2(0, stride.y);
    bool there = stays(start, walk) && walk.part < 1.0;
    int odd = (sideways ? walk.block.x : walk.block.y) & 1;
    int ahead = sideways ? forward.x : forward.y;
    if (odd != ahead && walk.level < top_level) {
        ++walk.level;
        walk.block >>= 1;
    }
    return there;
}

#ifndef STREAMED
bool find_exact_hit(vec3 start, vec3 span, out float part, out vec2 place) {
    part = 1.0;
    place = vec2(0.0);
    if (is_endless(start, span)) {
        return false;
    }
    Course course = course_of(span);
    // If unknown, the first cell decides; that is cheaper than a height lookup.
    bool above = begins_above || start.z >= 1.0;
    Walk walk;
    walk.level = min(top_level, start_level);
    walk.part = 0.0;
    walk.block = first_cell(start) >> walk.level;
    bool inside = true;
    while (inside) {
        vec2 exits = vec2(1.0);
        bool reached = false;
        while (inside && !reached) {
            count_step();
            exits = exits_of(start, course.inverse, course.forward, walk) + course.never;
            float leave = min(min(exits.x, exits.y), 1.0);
            float lowest = start.z + (course.falls ? leave : walk.part) * span.z;
            bool over = above && lowest > max_height_in(walk);
            reached = !over && walk.level == 0;
            if (over) {
                inside = move_on(exits, course.forward, start, walk);
            } else if (!reached) {
                descend(start, span, walk);
            }
        }
        if (reached) {
            count_step();
            count_taps(1.0);
            float leave = min(min(exits.x, exits.y), 1.0);
            vec4 corners = textureGather(height_map, (vec2(walk.block) + 1.0) * height_texel);
            float found =
                crossing(corners, start + walk.part * span - vec3(walk.block - origin_cell, 0.0),
                         (leave - walk.part) * span, walk.part, leave, above);
            if (found <= 1.0) {
                part = found;
                place = start.xy + part * span.xy;
                return true;
            }
            inside = move_on(exits, course.forward, start, walk);
        }
    }
    ends_above = above;
    return false;
}
#endif
