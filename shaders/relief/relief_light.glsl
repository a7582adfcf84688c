// A terrain's light, in maps.
#ifdef STREAMED
#define LIT_MAP sampler2DArray
#define LIT_COORDINATE vec3
#else
#define LIT_MAP sampler2D
#define LIT_COORDINATE vec2
uniform vec4 lit_from_sample; // texture coordinate = sample · xy + zw
#endif
layout(binding = lit_map_unit) uniform LIT_MAP lit_map; // reflected light, linear
#ifdef SHADOW
layout(binding = sun_map_unit) uniform LIT_MAP sun_map; // the sun's part; lit_map has the rest
#endif

struct LitPlace {
    LIT_COORDINATE coordinate;
    float level;
};

#ifdef STREAMED
// Cells of the finest tiles.
vec2 texels_at(vec2 place) {
    return place;
}

LitPlace lit_place(vec2 place, float level) {
    ivec2 cell = cell_at(place);
    StreamedTile tile = tile_of_page(page_of(cell).x);
    vec2 texel = vertex_at(place, cell, tile.level) * float(1 << tile.texel_level) + 0.5;
    return LitPlace(vec3(texel / vec2(textureSize(lit_map, 0).xy), tile.layer),
                    level + float(tile.texel_level - tile.level));
}
#else
vec2 texels_at(vec2 place) {
    return place * lit_from_sample.xy * vec2(textureSize(lit_map, 0)); // from the origin
}

LitPlace lit_place(vec2 place, float level) {
    vec2 sample_place = place + vec2(origin_cell);
    return LitPlace(sample_place * lit_from_sample.xy + lit_from_sample.zw, level);
}
#endif

vec3 reflected_at(LitPlace at) {
    count_taps(1.0);
    return textureLod(lit_map, at.coordinate, at.level).rgb;
}

#ifdef SHADOW
vec3 of_sun_at(LitPlace at) {
    count_taps(1.0);
    return textureLod(sun_map, at.coordinate, at.level).rgb;
}
#endif
