// How far the beam of a block of pixels meets nothing, along the view: the same search as over a plane, but in
// steps of depth.
#include "curved/curved_rays.glsl"

// Of a beam at a depth, in the search space.
struct Section {
    vec3 low;
    vec3 high;
};

// The edges of a beam: their parts are metres of depth.
Curve edges[4];

Section section_at(float depth) {
    Section found = Section(vec3(3e38), vec3(-3e38));
    for (int i = 0; i < 4; ++i) {
        curve = edges[i];
        vec3 place = curve_at(depth);
        found.low = min(found.low, place);
        found.high = max(found.high, place);
    }
    return found;
}

// Where the first edge may come down to the heights. Heights along a ray are convex, so tangents lie below them.
float depth_of_heights() {
    float first = 3e38;
    for (int i = 0; i < 4; ++i) {
        curve = edges[i];
        float depth = 0.0;
        for (int step = 0; step < 3; ++step) {
            float over = curve_at(depth).z - course_end.z;
            float slope = curve_slope_at(depth).z;
            if (over > 0.0) {
                depth = slope < 0.0 ? depth - over / slope : 3e38;
            }
        }
        first = min(first, depth);
    }
    return first;
}

// Between two sections the beam lies in their bounds, and beyond them by its bend: at most the curvature times
// the squared extent, over 4.
bool is_clear_between(Section first, Section last, float metres) {
    vec3 beyond = 0.25 * course_scale.w * metres * metres / course_scale.xyz;
    vec2 low = min(first.low.xy, last.low.xy) - beyond.xy;
    vec2 high = max(first.high.xy, last.high.xy) + beyond.xy;
    float lowest = min(first.low.z, last.low.z) - beyond.z + course_begin.z;
    return lowest > max_height_within(low, high);
}

// The step doubles in free space and halves where the beam may hit.
float clear_depth_of(vec2 low, vec2 high) {
    const int max_steps = 32;
    const float min_share = 1.0 / 512.0; // of the depth
    const float first_cells = 16.0;
    vec2 corners[4] = vec2[4](low, vec2(high.x, low.y), vec2(low.x, high.y), high);
    float longest = 0.0; // of a ray, per depth
    for (int i = 0; i < 4; ++i) {
        vec3 way = direction_of_ray * vec3(1.0, corners[i]);
        longest = max(longest, length(way));
        edges[i] = view_curve(way);
    }
    float width = distance(direction_of_ray * vec3(1.0, low), direction_of_ray * vec3(1.0, high));
    float depth = depth_of_heights();
    if (depth > 1e30) {
        return depth;
    }
    float cell = min(course_scale.x, course_scale.y);
    float stride = max(0.125 * depth, first_cells * cell);
    Section here = section_at(depth);
    for (int i = 0; i < max_steps && stride > min_share * depth + 0.25 * cell; ++i) {
        Section there = section_at(depth + stride);
        bool is_clear =
            is_clear_between(here, there, stride * longest + (depth + stride) * width);
        if (is_clear) {
            depth += stride;
            here = there;
        }
        stride *= is_clear ? 2.0 : 0.5;
    }
    return depth;
}
