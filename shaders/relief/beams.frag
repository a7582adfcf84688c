#include "frame/bindings.inc"
#include "frame/count.glsl"
#if defined(STREAMED) || defined(CURVED)
#include "frame/relief_block.glsl"
#endif
#ifdef STREAMED
uniform vec2 height_texel; // 1 / vertices of a tile
#include "stream/stream_tiles.glsl"
#include "stream/stream_max.glsl"
#endif

// The height (on the ellipsoid, the depth) down to which the beam of a block of pixels meets nothing (Laine and Karras 2010, beam
// optimization; here with a max mipmap).
#ifndef STREAMED
layout(binding = max_mipmap_unit) uniform sampler2D max_mipmap; // level 0: maximum of a cell's corners
uniform ivec2 last_cell;
uniform ivec2 origin_cell;
#endif
uniform int top_level;
// Search space; matrix · (1, x, y), with x and y as gl_FragCoord.
uniform mat3 origin_of_ray;
uniform mat3 direction_of_ray; // on the ellipsoid: in world metres, one metre of depth
uniform float begin_height;    // of the beams
uniform float beam_lift;       // margin for rounding errors, in heights

layout(location = 0) out float clear_height;
#ifdef COUNT
layout(location = 1) out vec2 taps_of_beam;
#define write_work() taps_of_beam = vec2(work_taps, 0.0)
#else
#define write_work()
#endif

#ifndef CURVED
// The four edges of a beam.
struct Beam {
    mat3x4 origins;
    mat3x4 directions;
};

Beam beam_of(vec2 low, vec2 high) {
    mat4x3 places = mat4x3(1.0, low, 1.0, high.x, low.y, 1.0, low.x, high.y, 1.0, high);
    return Beam(transpose(origin_of_ray * places), transpose(direction_of_ray * places));
}

struct Corners {
    vec4 cols;
    vec4 rows;
};

Corners section(Beam beam, float height) {
    const float beyond_all = 1e30;
    vec4 way = min((height - beam.origins[2]) / beam.directions[2], beyond_all);
    return Corners(beam.origins[0] + way * beam.directions[0],
                   beam.origins[1] + way * beam.directions[1]);
}

#endif

float smallest(vec4 values) {
    return min(min(values.x, values.y), min(values.z, values.w));
}

float largest(vec4 values) {
    return max(max(values.x, values.y), max(values.z, values.w));
}

#ifdef STREAMED
bool is_outside(vec2 low, vec2 high) {
    return any(greaterThan(low, box_end.xy)) || any(lessThan(high, box_begin.xy));
}

float max_height_in_block(ivec2 block, int level) {
    return max_height_of(block, level);
}
#else
bool is_outside(vec2 low, vec2 high) {
    vec2 origin = vec2(origin_cell);
    return any(greaterThan(low, vec2(last_cell + 1) - origin)) || any(lessThan(high, -origin));
}

ivec2 cell_at(vec2 place) {
    return ivec2(clamp(floor(place) + vec2(origin_cell), vec2(0.0), vec2(last_cell)));
}

float max_height_in_block(ivec2 block, int level) {
    count_taps(1.0);
    return texelFetch(max_mipmap, block, level).r;
}
#endif

// Maximum height over a rectangle, from the level where at largest four blocks cover it.
float max_height_within(vec2 low, vec2 high) {
    if (is_outside(low, high)) {
        return -1.0; // outside the surface
    }
    ivec2 first = cell_at(low);
    ivec2 last = cell_at(high);
    ivec2 extent = last - first;
    int level = min(findMSB(max(max(extent.x, extent.y) - 1, 0)) + 1, top_level);
    first >>= level;
    last >>= level;
    vec4 heights = vec4(max_height_in_block(first, level),
                        max_height_in_block(ivec2(last.x, first.y), level),
                        max_height_in_block(ivec2(first.x, last.y), level),
                        max_height_in_block(last, level));
    return largest(heights);
}

#ifdef CURVED
#include "curved/curved_beams.glsl"

void main() {
    float extent = float(pixels_a_beam);
    vec2 low = floor(gl_FragCoord.xy) * extent;
    clear_height = clear_depth_of(low, low + extent);
    write_work();
}
#else
float max_height_between(Corners upper, Corners lower) {
    return max_height_within(vec2(min(smallest(upper.cols), smallest(lower.cols)),
                                min(smallest(upper.rows), smallest(lower.rows))),
                           vec2(max(largest(upper.cols), largest(lower.cols)),
                                max(largest(upper.rows), largest(lower.rows))));
}

// Steps down; the step doubles in free space and halves where the beam may hit.
float clear_down_to(Beam beam) {
    const int max_steps = 24;
    const float min_step = 1.0 / 256.0;
    float height = begin_height;
    float down = height;
    Corners upper = section(beam, height);
    for (int i = 0; i < max_steps && down > min_step && height > 0.0; ++i) {
        float lower = max(height - down, 0.0);
        float reached = max(max_height_between(upper, section(beam, lower)), lower);
        down *= reached > lower ? 0.5 : 2.0;
        if (reached < height) {
            height = reached;
            upper = section(beam, height);
        }
    }
    return height;
}

void main() {
    float extent = float(pixels_a_beam);
    vec2 low = floor(gl_FragCoord.xy) * extent;
    Beam beam = beam_of(low, low + extent);
    bool falls = all(lessThan(beam.directions[2], vec4(0.0)));
    clear_height = falls ? clear_down_to(beam) + beam_lift : begin_height + beam_lift;
    write_work();
}
#endif
