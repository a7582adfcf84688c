// Maximum heights of a streamed terrain.
layout(binding = max_mipmap_unit) uniform sampler2DArray max_mipmaps; // metres; level 0: a cell's corners

// Over a block of 2^level cells that is no smaller than the cells of its tile; `page`: its page_of_block().
float max_height_of(ivec2 block, int level, vec2 page, StreamedTile tile) {
    int up = level - tile.level;
    float metres = page.y;
    if (up < page_level) {
        ivec2 texel = block & ((page_cells >> up) - 1);
        metres = texelFetch(max_mipmaps, ivec3(texel, int(tile.layer)), up).r;
    }
    return unit_height(metres);
}
