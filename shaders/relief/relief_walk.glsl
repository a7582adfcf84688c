#include "relief/relief_cell.glsl"

// The true first hit: down a pyramid of greatest heights (Tevs, Ihrke and Seidel 2008) to the cells
// the ray may touch, where the bilinear surface along it is a quadratic. The inner loop only
// descends and moves on, one tap a turn.
layout(binding = max_mipmap_unit) uniform sampler2D max_mipmap; // level 0: of a cell's corners
uniform ivec2 last_cell;
uniform int top_level;

#ifdef BEAMS
const int start_level = 2; // the ray begins near the surface
#else
const int start_level = 5;
#endif

// The way of a ray through the blocks of one level.
struct Walk {
    int level;
    ivec2 block;
    float part; // where the ray enters the block
};

// Whether a ray would never leave.
bool is_endless(vec3 start, vec3 span);
// The cell a ray begins in.
ivec2 first_cell(inout vec3 start);
// Where along the ray the walk leaves its block through a column's and through a row's border.
vec2 exits_of(vec3 start, vec2 inverse, ivec2 forward, Walk walk);
// After a step into another block: whether there is one.
bool stays(inout vec3 start, inout Walk walk);
float greatest_in(Walk walk);

// Into the next block, and up a level where that begins a new one there. False where there is none.
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

bool find_hit(vec3 start, vec3 span, out float part, out vec2 place) {
    part = 1.0;
    place = vec2(0.0);
    if (is_endless(start, span)) {
        return false;
    }
    ivec2 forward = ivec2(greaterThan(span.xy, vec2(0.0)));
    // A ray along an axis never leaves through that axis's borders.
    vec2 inverse = vec2(span.x != 0.0 ? 1.0 / span.x : 0.0, span.y != 0.0 ? 1.0 / span.y : 0.0);
    vec2 never = vec2(span.x != 0.0 ? 0.0 : 2.0, span.y != 0.0 ? 0.0 : 2.0);
    bool falls = span.z < 0.0;
    // Where that is not known, the first cell tells, for less than a look at its height.
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
            exits = exits_of(start, inverse, forward, walk) + never;
            float leave = min(min(exits.x, exits.y), 1.0);
            float lowest = start.z + (falls ? leave : walk.part) * span.z;
            bool over = above && lowest > greatest_in(walk);
            reached = !over && walk.level == 0;
            if (over) {
                inside = move_on(exits, forward, start, walk);
            } else if (!reached) {
                --walk.level;
                vec2 middle = vec2((2 * walk.block + 1) << walk.level);
                vec2 p = start.xy + walk.part * span.xy;
                walk.block = 2 * walk.block + ivec2(greaterThanEqual(p, middle));
            }
        }
        if (reached) {
            float leave = min(min(exits.x, exits.y), 1.0);
            float found = crossing(start, span, walk.block, walk.part, leave, above);
            if (found <= 1.0) {
                part = found;
                place = start.xy + part * span.xy;
                return true;
            }
            inside = move_on(exits, forward, start, walk);
        }
    }
    return false;
}
