// The part at which the ray crosses a cell's bilinear surface downwards; 2 if it does not. `corners`: as from
// textureGather; `enter`, `way`: of the ray in the cell, whose sides are 1; `above`: the ray enters above the
// surface, despite rounding.
float crossing(vec4 corners, vec3 enter, vec3 way, float begin, float end, inout bool above) {
    float h01 = corners.x;
    float h11 = corners.y;
    float h10 = corners.z;
    float h00 = corners.w;
    float east = h10 - h00;
    float south = h01 - h00;
    float twist = h00 - h10 - h01 + h11;
    float c0 = enter.z - (h00 + enter.x * east + enter.y * south + enter.x * enter.y * twist);
    float c1 = way.z - (east * way.x + south * way.y +
                        twist * (enter.x * way.y + enter.y * way.x));
    float c2 = -twist * way.x * way.y;
    if (above && c0 < 0.0) {
        return begin; // crossed on the border
    }
    float root = 2.0;
    float under_root = c1 * c1 - 4.0 * c2 * c0;
    if (under_root >= 0.0) {
        float slope = sqrt(under_root);
        root = c1 < 0.0 ? 2.0 * c0 / (slope - c1) : (-c1 - slope) / (2.0 * c2);
    }
    above = c0 + c1 + c2 >= 0.0;
    return root >= 0.0 && root <= 1.0 ? begin + root * (end - begin) : 2.0;
}

#ifndef TILE
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
#endif
