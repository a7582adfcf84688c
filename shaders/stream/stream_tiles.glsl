// The heights of a streamed terrain. The search space's x and y count the cells of the finest drawn tiles,
// from origin_cell on. A page is a square of page_cells cells a side; it lies in one drawn tile, which has as
// many cells a side, but larger ones if it is coarser.
layout(binding = height_map_unit) uniform sampler2DArray height_tiles; // metres at the vertices
// x: tile_of_page; y: maximum height, metres. Texels of level n cover 2^n × 2^n pages: x is of the first.
layout(binding = pages_unit) uniform sampler2D pages;
uniform ivec2 origin_cell;
uniform ivec2 last_cell;

const int page_level = findMSB(page_cells);

// The tile of a page.
struct StreamedTile {
    float layer;
    int level;           // a cell of the tile is 2^level cells wide
    int texel_level;     // 2^texel_level texels of the lit map in a cell of the tile
};

StreamedTile tile_of_page(float packed_tile) {
    int packed_bits = int(packed_tile);
    return StreamedTile(float(packed_bits & 0xFFF), (packed_bits >> 12) & 0x1F, packed_bits >> 17);
}

float unit_height(float metres) {
    return (metres - height_span.x) * height_span.z;
}

vec2 page_of(ivec2 cell) {
    count_taps(1.0);
    return texelFetch(pages, cell >> page_level, 0).xy;
}

// The page of a block of 2^level cells, or the first of its pages and the maximum of all.
vec2 page_of_block(ivec2 block, int level) {
    count_taps(1.0);
    int up = max(level - page_level, 0);
    return texelFetch(pages, block >> max(page_level - level, 0), up).xy;
}

ivec2 cell_at(vec2 place) {
    return clamp(ivec2(floor(clamp(place, box_begin.xy, box_end.xy))) + origin_cell, ivec2(0), last_cell);
}

// A tile's cell in the search space. The terrain's end may cut it.
struct TileCell {
    vec2 corner;
    vec2 extent;
    ivec2 index; // in its tile
};

TileCell tile_cell(ivec2 cell, int level) {
    ivec2 number = cell >> level;
    vec2 corner = vec2((number << level) - origin_cell);
    return TileCell(corner, min(vec2(1 << level), box_end.xy - corner), number & (page_cells - 1));
}

// A place in vertices of its tile.
vec2 vertex_at(vec2 place, ivec2 cell, int level) {
    TileCell found = tile_cell(cell, level);
    return vec2(found.index) + (place - found.corner) / found.extent;
}

float height_at(vec2 place) {
    ivec2 cell = cell_at(place);
    StreamedTile tile = tile_of_page(page_of(cell).x);
    vec2 vertex = vertex_at(place, cell, tile.level);
    count_taps(1.0);
    return unit_height(textureLod(height_tiles, vec3((vertex + 0.5) * height_texel, tile.layer), 0.0).r);
}
