#define PER_SAMPLE
#include "frame/frame_block.glsl"
#include "frame/fragment.glsl"
#include "frame/air.glsl"
#include "material/surface_shader.glsl"
#include "relief/relief_surface.glsl"
#include "relief/relief_cell.glsl"
#if defined(EXACT) && defined(STREAMED)
#include "stream/stream_walk.glsl"
#elif defined(EXACT)
#include "relief/relief_exact.glsl"
#elif defined(CONE)
#ifdef STREAMED
#include "stream/stream_walk.glsl"
#else
#include "relief/relief_exact.glsl"
#endif
#include "relief/relief_cone.glsl"
#elif defined(PARALLAX)
#include "relief/relief_parallax.glsl"
#else
#include "relief/relief_linear.glsl"
#endif
#ifdef FADE
#include "relief/relief_fade.glsl"
#endif
#ifdef BEAMS
#include "relief/relief_beams.glsl"
#endif
#if defined(HARD_SHADOW) || defined(SOFT_SHADOW)
#define SHADOW
#include "relief/relief_shadow.glsl"
#endif
#ifdef SMOOTH_EDGES
#include "relief/relief_edges.glsl"
#endif

in vec3 vertex_back;

// From world directions relative to the eye to the search space: column, row, height in [0,1].
uniform mat3 space_from_relative;
uniform vec3 eye_in_space;
uniform vec2 texels_of_light; // x: at the eye; y: per metre of distance
#include "relief/relief_light.glsl"
#ifdef POINT_LIGHTS
#include "terrain/ground_points.glsl"
#endif
#ifdef MESH_SHADOWS
#include "material/mesh_shadow.glsl"
#endif
#ifdef OVERLAY
#include "terrain/overlay.glsl"

// By which heights rise across a cell, at a place in it.
vec2 rises_in(SurfaceCell cell) {
    return vec2(mix(cell.corners.z - cell.corners.w, cell.corners.y - cell.corners.x, cell.part.y),
                mix(cell.corners.x - cell.corners.w, cell.corners.y - cell.corners.z, cell.part.x));
}

vec3 overlaid_at(vec3 lit, vec2 place, vec3 relative) {
    SurfaceCell cell = surface_cell(place);
    vec2 rises = rises_in(cell);
    vec3 perpendicular = mat3(grain_normal_from_slopes) * vec3(-rises / cell.extent, 1.0);
    float height = height_span.x + height_span.y * height_in(cell);
#ifdef STREAMED
    vec2 at = place; // without façades
#else
    vec2 at = place + vec2(origin_cell);
#endif
    return overlaid(lit, ground_place(relative, perpendicular), at, height, any(notEqual(rises, vec2(0.0))));
}
#endif
#ifdef HIT
uniform vec4 origin_sample;   // xy: col, row of the search space's origin; zw: to be added
uniform float samples_a_cell; // of a terrain in memory, 1; of streamed tiles, of the finest
#endif

#include "frame/output.glsl"

#ifdef COUNT
#define write_work() work = vec4(work_taps, work_steps, work_rays, 1.0)
#define SHOW_NOTHING write_work(); return
#else
#define write_work()
#define SHOW_NOTHING discard
#endif

#ifdef HIT
// origin_sample plus the place as two floats (Knuth's two-sum).
void write_place(vec2 place, float height, float depth) {
    vec2 offset = place * samples_a_cell; // exact: a power of two
    precise vec2 sum = origin_sample.xy + offset;
    precise vec2 added = sum - origin_sample.xy;
    precise vec2 low = ((origin_sample.xy - (sum - added)) + (offset - added)) + origin_sample.zw;
    precise vec2 high = sum + low;
    precise vec2 rest = low - (high - sum);
    hit = vec4(high, height, depth);
    hit_low = rest;
}
#endif

#ifdef CURVED
// The place has the direction of the pixel, because graphics processors interpolate with fewer digits than floats
// have.
vec3 back_on_ray() {
    vec3 inside = INSIDE(vertex_back);
    return mix(inside, pixel_ray() * dot(inside, view_forward.xyz), perspective);
}

#include "curved/curved_search.glsl"
#ifdef SHADOW
#include "curved/curved_light.glsl"
#endif
#else
// A ray in the search space, and the same relative to the eye.
struct StraightRay {
    vec3 start;
    vec3 span;
    vec3 relative_start;
    vec3 relative_span;
};

// From its entry into the box, in perspective not before the near plane, to where it leaves. Only orthographic rays are
// interpolated, because graphics processors do it with fewer digits than floats have. A ray in perspective is computed
// from its pixel, and its parts are depths.
StraightRay ray_in_box() {
    vec3 origin = mix(INSIDE(vertex_back), vec3(0.0), perspective);
    vec3 along = mix(view_forward.xyz, pixel_ray(), perspective);
    vec3 from = space_from_relative * origin + eye_in_space;
    vec3 direction = space_from_relative * along;
    vec3 away = vec3(equal(direction, vec3(0.0)));
    vec3 inverse = (1.0 - away) / (direction + away);
    vec3 low = (box_begin.xyz - from) * inverse;
    vec3 high = (box_end.xyz - from) * inverse;
    vec3 enters = min(low, high) - away * 3e38;
    vec3 leaves = max(low, high) + away * 3e38;
    float end = max(min(min(leaves.x, leaves.y), leaves.z), 0.0);
    float begin = min(near_depth, end);
    float enter = max(max(enters.x, enters.y), enters.z);
    if (perspective > 0.5 && enter < begin) { // from the eye: near it floats are precise
        float way = end - begin;
        return StraightRay(from + begin * direction, way * direction, begin * along, way * along);
    }
    // The ray leaves on a face exactly, however small the relief is.
    vec3 faces = mix(box_begin.xyz, box_end.xyz, greaterThan(direction, vec3(0.0)));
    vec3 leave = mix(from + end * direction, faces, lessThanEqual(leaves, vec3(end)));
    vec3 first = min((box_begin.xyz - leave) * inverse, (box_end.xyz - leave) * inverse) - away * 3e38;
    float entry = min(max(max(first.x, first.y), first.z), 0.0);
    return StraightRay(leave + entry * direction, -entry * direction, origin + (end + entry) * along,
                       -entry * along);
}
#endif

#ifndef HIT
// Mip level from derivatives, limited to an anisotropy of 8: over a silhouette the neighbours show another
// place.
float level_of(vec2 place, float distance_to_hit) {
#ifdef CURVED
    vec2 across = texels_at(within_half_turn(dFdx(place)));
    vec2 down = texels_at(within_half_turn(dFdy(place)));
#else
    vec2 texels = texels_at(place);
    vec2 across = dFdx(texels);
    vec2 down = dFdy(texels);
#endif
    float longest = 8.0 * (texels_of_light.x + distance_to_hit * texels_of_light.y);
    return 0.5 * log2(min(max(dot(across, across), dot(down, down)), longest * longest));
}

#ifdef SMOOTH_EDGES
// For a missed place, whose neighbours show other places.
float near_level(float level, float distance_to_hit) {
    return min(level, log2(2.0 * (texels_of_light.x + distance_to_hit * texels_of_light.y)));
}
#endif
#endif

#ifndef HIT
#ifdef SHADOW
#if defined(EXACT) && defined(HARD_SHADOW)
#define CERTAIN_SUN
layout(binding = certain_sun_unit) uniform sampler2D certain_sun; // of cells, where has_certain_sun: 1 lit, 2 dark, 0 neither
uniform int has_certain_sun;
#endif

float share_of_sun_at(vec2 place, vec3 relative) {
#ifdef CERTAIN_SUN
    if (has_certain_sun != 0) {
        count_taps(1.0);
        ivec2 cell = clamp(ivec2(floor(place)) + origin_cell, ivec2(0), last_cell);
        float certain = texelFetch(certain_sun, cell, 0).r;
        if (certain > 0.5) {
            return 2.0 - certain;
        }
    }
#endif
#ifdef CURVED
    return sun_over_earth(place, relative);
#else
    vec3 sun_direction = space_from_relative * to_sun.xyz;
#ifdef FACING
    return sun_from_hit(place, sun_direction, box_begin.xyz, box_end.xyz);
#else
    return sun_at(place, sun_direction, box_begin.xyz, box_end.xyz);
#endif
#endif
}
#endif

// `relative`: the place, relative to the eye.
vec3 lit_at(vec2 place, float level, vec3 relative) {
    LitPlace at = lit_place(place, level);
    vec3 lit = reflected_at(at);
#ifdef SHADOW
    float sun = share_of_sun_at(place, relative);
#ifdef MESH_SHADOWS
    sun = sun > 0.0 ? sun * sun_on_ground(relative) : 0.0;
#endif
    lit += sun * of_sun_at(at);
#endif
    return lit;
}

vec3 color_at(vec2 place, float level, vec3 relative, float metres) {
    vec3 lit = lit_at(place, level, relative);
#ifdef POINT_LIGHTS
    LitPlace at = lit_place(place, level);
    vec3 from_points = reflected_from_points(textureLod(lit_albedo, at.coordinate, at.level).rgb,
                                             textureLod(lit_normals, at.coordinate, at.level).xyz, relative);
#ifdef OVERLAY
    light_under_overlay = from_points;
#else
    lit += from_points;
#endif
#endif
#ifdef OVERLAY
    lit = overlaid_at(lit, place, relative);
#endif
    return seen_through_air(shaded(lit, relative), metres);
}
#endif

#ifndef CURVED
bool find_view_hit(vec3 start, vec3 span, out float part, out vec2 place) {
    count_ray();
#ifdef BEAMS
    float clear = clear_part(start, span);
    begins_above = clear > 0.0;
    bool found = find_hit(start + clear * span, (1.0 - clear) * span, part, place);
    begins_above = false;
    part = mix(clear, 1.0, part);
    return found;
#else
    return find_hit(start, span, part, place);
#endif
}
#endif

void main() {
#ifdef CURVED
    float part;
    vec2 place;
    count_ray();
    if (!find_on_curve(part, place)) {
        SHOW_NOTHING;
    }
    vec3 relative = on_view_ray(part);
#else
    StraightRay ray = ray_in_box();
    vec3 start = ray.start;
    vec3 span = ray.span;
#ifdef FADE
    vec2 ends = stretch(box_begin.z, box_end.z, start, span);
#endif
    float part;
    vec2 place;
    if (!find_view_hit(start, span, part, place)) {
        SHOW_NOTHING;
    }
#ifdef FADE
    float way = mix(ends.x, ends.y, part);
#else
    float way = part;
#endif
    vec3 relative = ray.relative_start + way * ray.relative_span;
#endif
#ifdef WRITE_DEPTH
    vec4 clip = clip_from_relative * vec4(relative, 1.0);
    gl_FragDepth = clip.z / clip.w;
#endif
#ifdef HIT
    float height = height_span.x + height_span.y * height_in(surface_cell(place));
    write_place(place, height, dot(relative, view_forward.xyz));
#else
    float metres = length(relative);
    float level = level_of(place, metres);
    vec3 shown = color_at(place, level, relative, metres);
#ifdef SMOOTH_EDGES
    vec2 missed;
    float at;
#ifdef CURVED
    vec3 start = curve_at(curve_range.x);
    vec3 way = nearest_turn(start, curve_at(curve_range.y)) - start;
    float distance_share = near_miss(start, way, at, missed);
    vec3 past = on_view_ray(mix(curve_range.x, curve_range.y, at));
#else
    float distance_share = near_miss(start, part * span, at, missed);
    vec3 past = relative;
#endif
    if (distance_share < 1.0) {
        vec3 behind = color_at(missed, near_level(level, metres), past, metres);
        shown = mix(behind, shown, distance_share);
    }
#endif
    color = vec4(shown, 1.0);
    write_work();
#endif
}
