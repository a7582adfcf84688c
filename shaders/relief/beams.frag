#include "frame/bindings.inc"

// A pixel here is the beam of all rays of a block of pixels: down to which height it meets nothing of a
// relief (Laine and Karras 2010, beam optimization; here on a pyramid of greatest heights).
layout(binding = max_mipmap_unit) uniform sampler2D max_mipmap; // level 0: of a cell's corners
uniform ivec2 last_cell;
uniform int top_level;
// Of the search space, of the place (1, x, y) on the picture, as gl_FragCoord.
uniform mat3 origin_of_ray;
uniform mat3 direction_of_ray;
uniform float begin_height; // where beams begin
uniform float beam_lift;    // in heights: rounding puts no ray below the surface above it

layout(location = 0) out float clear_height;

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

float least(vec4 values) {
    return min(min(values.x, values.y), min(values.z, values.w));
}

float most(vec4 values) {
    return max(max(values.x, values.y), max(values.z, values.w));
}

// Of the surface below or above a rectangle; looked up where no more than four blocks cover it.
float greatest_within(vec2 low, vec2 high) {
    vec2 end = vec2(last_cell);
    if (any(greaterThan(low, end + 1.0)) || any(lessThan(high, vec2(0.0)))) {
        return -1.0; // there is none
    }
    ivec2 first = ivec2(clamp(low, vec2(0.0), end));
    ivec2 last = ivec2(clamp(high, vec2(0.0), end));
    ivec2 extent = last - first;
    int level = min(findMSB(max(max(extent.x, extent.y) - 1, 0)) + 1, top_level);
    first >>= level;
    last >>= level;
    vec4 heights = vec4(texelFetch(max_mipmap, first, level).r,
                        texelFetch(max_mipmap, ivec2(last.x, first.y), level).r,
                        texelFetch(max_mipmap, ivec2(first.x, last.y), level).r,
                        texelFetch(max_mipmap, last, level).r);
    return most(heights);
}

float greatest_between(Corners upper, Corners lower) {
    return greatest_within(vec2(min(least(upper.cols), least(lower.cols)),
                                min(least(upper.rows), least(lower.rows))),
                           vec2(max(most(upper.cols), most(lower.cols)),
                                max(most(upper.rows), most(lower.rows))));
}

// Down in steps that double where nothing was met and halve where something may be.
float clear_down_to(Beam beam) {
    const int looks = 24;
    const float min_step = 1.0 / 256.0;
    float height = begin_height;
    float down = height;
    Corners upper = section(beam, height);
    for (int i = 0; i < looks && down > min_step && height > 0.0; ++i) {
        float lower = max(height - down, 0.0);
        float reached = max(greatest_between(upper, section(beam, lower)), lower);
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
}
