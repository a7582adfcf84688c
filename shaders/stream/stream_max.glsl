// Maximum heights of a streamed terrain.
layout(binding = max_mipmap_unit) uniform sampler2DArray max_mipmaps; // metres; level 0: a cell's corners

// Over a block of 2^level cells, or over what contains it: a larger cell of its tile, or its page.
float max_height_of(ivec2 block, int level) {
    vec2 page = page_of_block(block, level);
    StreamedTile tile = tile_of_page(page.x);
    float metres = page.y;
    if (level < page_level && tile.level < page_level) {
        int coarser = max(tile.level - level, 0);
        int up = level + coarser - tile.level;
        ivec2 texel = (block >> coarser) & ((page_cells >> up) - 1);
        count_taps(1.0);
        metres = texelFetch(max_mipmaps, ivec3(texel, int(tile.layer)), up).r;
    }
    return unit_height(metres);
}
