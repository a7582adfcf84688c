#include "relief_cell.glsl"

// The true first hit: down a pyramid of greatest heights (Tevs, Ihrke and Seidel 2008) to the cells
// the ray may touch, where the bilinear surface along it is a quadratic. The inner loop only
// descends and moves on, one tap a turn.
layout(binding = 2) uniform sampler2D greatest_heights; // level 0: of a cell's corners
uniform ivec2 last_cell;
uniform int top_level;

// The way of a ray through the blocks of one level.
struct Walk {
    int level;
    ivec2 block;
    float part; // where the ray enters the block
};

// Where along the ray the walk leaves its block through a column's and through a row's border.
vec2 exits_of(vec3 start, vec2 inverse, ivec2 forward, Walk walk) {
    vec2 border = vec2((walk.block + forward) << walk.level);
    return max((border - start.xy) * inverse, walk.part);
}

// Into the next block, and up a level where that begins a new one there. False where there is none.
bool move_on(vec2 exits, ivec2 forward, inout Walk walk) {
    walk.part = min(exits.x, exits.y);
    bool sideways = exits.x <= exits.y;
    ivec2 stride = 2 * forward - 1;
    walk.block += sideways ? ivec2(stride.x, 0) : ivec2(0, stride.y);
    ivec2 beyond = last_cell >> walk.level;
    bool there = walk.part < 1.0 && all(greaterThanEqual(walk.block, ivec2(0))) &&
                 all(lessThanEqual(walk.block, beyond));
    int odd = (sideways ? walk.block.x : walk.block.y) & 1;
    int ahead = sideways ? forward.x : forward.y;
    if (odd != ahead && walk.level < top_level) {
        ++walk.level;
        walk.block >>= 1;
    }
    return there;
}

#ifdef BEAMS
const int start_level = 2; // the ray begins near the surface
#else
const int start_level = 5;
#endif

bool find_hit(vec3 start, vec3 span, out float part, out vec2 place) {
    ivec2 forward = ivec2(greaterThan(span.xy, vec2(0.0)));
    // A ray along an axis never leaves through that axis's borders.
    vec2 inverse = vec2(span.x != 0.0 ? 1.0 / span.x : 0.0, span.y != 0.0 ? 1.0 / span.y : 0.0);
    vec2 never = vec2(span.x != 0.0 ? 0.0 : 2.0, span.y != 0.0 ? 0.0 : 2.0);
    bool above = start.z >= height_at(start.xy);
    Walk walk;
    walk.level = min(top_level, start_level);
    walk.part = 0.0;
    walk.block = clamp(ivec2(start.xy), ivec2(0), last_cell) >> walk.level;
    bool inside = true;
    while (inside) {
        vec2 exits = vec2(1.0);
        bool reached = false;
        while (inside && !reached) {
            exits = exits_of(start, inverse, forward, walk) + never;
            float leave = min(min(exits.x, exits.y), 1.0);
            float lowest = start.z + (span.z < 0.0 ? leave : walk.part) * span.z;
            bool over = above && lowest > texelFetch(greatest_heights, walk.block, walk.level).r;
            reached = !over && walk.level == 0;
            if (over) {
                inside = move_on(exits, forward, walk);
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
            inside = move_on(exits, forward, walk);
        }
    }
    part = 1.0;
    place = vec2(0.0);
    return false;
}
