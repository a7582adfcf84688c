#include "relief/relief_walk.glsl"

// Over the tiles of a streamed terrain.
bool is_endless(vec3 start, vec3 span) {
    return false;
}

ivec2 first_cell(inout vec3 start) {
    return cell_at(start.xy);
}

void settle(inout Walk walk) {
    walk.page = page_of_block(walk.block, walk.level);
    int tile_level = tile_of_page(walk.page.x).level;
    if (walk.level < tile_level) {
        walk.block >>= tile_level - walk.level;
        walk.level = tile_level;
    }
}

bool is_cell(Walk walk) {
    return walk.level == tile_of_page(walk.page.x).level;
}

vec2 place_of(ivec2 corner) {
    return vec2(corner - origin_cell);
}

vec2 exits_of(vec3 start, vec2 inverse, ivec2 forward, Walk walk) {
    vec2 border = place_of((walk.block + forward) << walk.level);
    return max((border - start.xy) * inverse, walk.part);
}

bool stays(inout vec3 start, inout Walk walk) {
    ivec2 beyond = last_cell >> walk.level;
    return all(greaterThanEqual(walk.block, ivec2(0))) && all(lessThanEqual(walk.block, beyond));
}

float max_height_in(Walk walk) {
    return max_height_of(walk.block, walk.level, walk.page, tile_of_page(walk.page.x));
}

float crossing_in(vec3 start, vec3 span, Walk walk, float leave, inout bool above) {
    StreamedTile tile = tile_of_page(walk.page.x);
    TileCell cell = tile_cell(walk.block << walk.level, walk.level);
    vec4 corners =
        textureGather(height_tiles, vec3((vec2(cell.index) + 1.0) * height_texel, tile.layer));
    corners = (corners - height_span.x) * height_span.z;
    vec3 low = vec3(cell.corner, 0.0);
    vec3 size = vec3(cell.extent, 1.0);
    return crossing(corners, (start + walk.part * span - low) / size,
                    (leave - walk.part) * span / size, walk.part, leave, above);
}

#ifndef CONE
bool find_hit(vec3 start, vec3 span, out float part, out vec2 place) {
    return find_exact_hit(start, span, part, place);
}
#endif
