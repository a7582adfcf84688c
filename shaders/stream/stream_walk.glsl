#include "relief/relief_walk.glsl"

// Over the tiles of a streamed terrain: between pages, the walk looks at their maxima; in a page it is that
// of a terrain in memory, with one texel fetch a turn.
vec2 exits_of(vec3 start, vec2 inverse, ivec2 forward, Walk walk) {
    vec2 border = vec2(((walk.block + forward) << walk.level) - origin_cell);
    return max((border - start.xy) * inverse, walk.part);
}

bool stays(inout vec3 start, inout Walk walk) {
    ivec2 beyond = last_cell >> walk.level;
    return all(greaterThanEqual(walk.block, ivec2(0))) && all(lessThanEqual(walk.block, beyond));
}

ivec2 existing(ivec2 block, int level) {
    return min(block, last_cell >> level);
}

float crossing_in(vec3 start, vec3 span, Walk walk, StreamedTile tile, float leave, inout bool above) {
    TileCell cell = tile_cell(walk.block << walk.level, tile.level);
    count_taps(1.0);
    vec4 corners =
        textureGather(height_tiles, vec3((vec2(cell.index) + 1.0) * height_texel, tile.layer));
    corners = (corners - height_span.x) * height_span.z;
    vec3 low = vec3(cell.corner, 0.0);
    vec3 size = vec3(cell.extent, 1.0);
    return crossing(corners, (start + walk.part * span - low) / size,
                    (leave - walk.part) * span / size, walk.part, leave, above);
}

bool find_exact_hit(vec3 start, vec3 span, out float part, out vec2 place) {
    part = 1.0;
    place = vec2(0.0);
    Course course = course_of(span);
    bool above = begins_above || start.z >= 1.0;
    Walk walk;
    walk.level = min(top_level, start_level);
    walk.part = 0.0;
    walk.block = cell_at(start.xy) >> walk.level;
    bool inside = true;
    while (inside) {
        count_step();
        vec2 page = page_of_block(walk.block, walk.level);
        StreamedTile tile = tile_of_page(page.x);
        // A block within a larger cell becomes that cell, or its page: other pages of the cell may show
        // finer tiles.
        int coarser = max(min(tile.level, page_level) - walk.level, 0);
        walk.level += coarser;
        walk.block >>= coarser;
        bool in_page = walk.level < page_level;
        ivec2 number = walk.block >> max(page_level - walk.level, 0);
        bool reached = false;
        vec2 exits = exits_of(start, course.inverse, course.forward, walk) + course.never;
        if (!in_page) {
            float leave = min(min(exits.x, exits.y), 1.0);
            float lowest = start.z + (course.falls ? leave : walk.part) * span.z;
            if (above && lowest > unit_height(page.y)) {
                inside = move_on(exits, course.forward, start, walk);
            } else if (walk.level == page_level && tile.level >= page_level) {
                reached = true;
            } else {
                descend(start, span, walk);
            }
        }
        while (inside && in_page && !reached) {
            count_step();
            count_taps(1.0);
            exits = exits_of(start, course.inverse, course.forward, walk) + course.never;
            float leave = min(min(exits.x, exits.y), 1.0);
            float lowest = start.z + (course.falls ? leave : walk.part) * span.z;
            int up = walk.level - tile.level;
            ivec2 texel = walk.block & ((page_cells >> up) - 1);
            float highest = unit_height(texelFetch(max_mipmaps, ivec3(texel, int(tile.layer)), up).r);
            bool over = above && lowest > highest;
            reached = !over && up == 0;
            if (over) {
                inside = move_on(exits, course.forward, start, walk);
                in_page = walk.level < page_level &&
                          walk.block >> max(page_level - walk.level, 0) == number;
            } else if (!reached) {
                descend(start, span, walk);
            }
        }
        if (reached) {
            float leave = min(min(exits.x, exits.y), 1.0);
            float found = crossing_in(start, span, walk, tile, leave, above);
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

#ifndef CONE
bool find_hit(vec3 start, vec3 span, out float part, out vec2 place) {
    return find_exact_hit(start, span, part, place);
}
#endif
