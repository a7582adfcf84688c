// The bilinear surface in the cell of a hit, as exact as the hit: filtered heights may be rounded to 1/256 of a
// cell, which is decimetres on a wall.
struct SurfaceCell {
    vec4 corners; // as from textureGather
    vec2 part;    // of the place, [0,1]
    vec2 extent;  // in the search space
};

#ifdef STREAMED
SurfaceCell surface_cell(vec2 place) {
    ivec2 cell = cell_at(place);
    StreamedTile tile = tile_of_page(page_of(cell).x);
    TileCell found = tile_cell(cell, tile.level);
    count_taps(1.0);
    vec4 corners =
        textureGather(height_tiles, vec3((vec2(found.index) + 1.0) * height_texel, tile.layer));
    return SurfaceCell((corners - height_span.x) * height_span.z,
                       clamp((place - found.corner) / found.extent, 0.0, 1.0), found.extent);
}
#else
SurfaceCell surface_cell(vec2 place) {
    ivec2 last = textureSize(height_map, 0) - 2;
    ivec2 cell = clamp(ivec2(floor(place)) + origin_cell, ivec2(0), last);
    count_taps(1.0);
    vec4 corners = textureGather(height_map, (vec2(cell) + 1.0) * height_texel);
    return SurfaceCell(corners, clamp(place - vec2(cell - origin_cell), 0.0, 1.0), vec2(1.0));
}
#endif

float height_in(SurfaceCell cell) {
    vec2 columns = mix(cell.corners.wz, cell.corners.xy, cell.part.y);
    return mix(columns.x, columns.y, cell.part.x);
}
