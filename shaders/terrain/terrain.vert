#include "frame/frame_block.glsl"

layout(location = 0) in vec3 position; // local metres
layout(location = 3) in vec3 rest;     // local metres, to be added to the position

uniform vec3 eye;      // local metres
uniform vec3 eye_rest; // local metres, to be added
uniform mat3 world_from_local;

#ifdef SLIVER
flat out int first_corner;
#else
layout(location = 1) in vec2 place; // samples from the tile's first
#if defined(HIT) || defined(OVERLAY)
layout(location = 2) in float height; // true metres
#endif

out vec2 tile_place; // samples from the tile's first
#ifdef HIT
uniform vec4 eye_in_tile; // xy: samples from the tile's first; zw: to be added

out vec2 place_from_eye;   // samples
out vec2 height_and_depth; // true metres; metres along the view axis
#endif
#ifdef GROUND
out vec3 local_from_eye; // metres
#elif defined(MULTISAMPLED) || defined(OVERLAY) || defined(POINT_LIGHTS) || defined(MESH_SHADOWS) || \
    defined(SURFACE_SHADER)
out vec3 way_from_eye; // metres
#endif
#ifdef MULTISAMPLED
out float one;
#endif
#ifdef OVERLAY
out float ground_height; // true metres
#endif
#endif

invariant gl_Position; // slivers are drawn by another program than their neighbours

// Snaps to the rasterizer's vertex grid before interpolation. Otherwise triangles seen edge-on show places
// beyond their border, on cliffs pixels away.
vec4 on_vertex_grid(vec4 clip) {
    const float farthest = 1048576.0; // floats still resolve 1/8 step
    vec2 steps = clip.xy / clip.w * vertex_grid.xy;
    bool is_on_it = clip.w > 0.0 && max(abs(steps.x), abs(steps.y)) < farthest;
    return is_on_it ? vec4(round(steps) / vertex_grid.xy * clip.w, clip.zw) : clip;
}

// `relative`: from the eye, world metres.
void set_position(vec3 relative) {
    gl_Position = on_vertex_grid(clip_from_relative * vec4(relative, 1.0));
}

void main() {
    // Equal bits for shared vertices of two tiles, so there are no cracks. Differences of neighbouring floats
    // are exact (Cozzi and Ring 2011, "3D Engine Design for Virtual Globes", 5.4).
    precise vec3 from_eye = (position - eye) + (rest - eye_rest);
    vec3 relative = world_from_local * from_eye;
#ifdef SLIVER
    first_corner = gl_VertexID - gl_VertexID % 3;
#else
    tile_place = place;
#ifdef GROUND
    local_from_eye = from_eye;
#elif defined(MULTISAMPLED) || defined(OVERLAY) || defined(POINT_LIGHTS) || defined(MESH_SHADOWS) || \
    defined(SURFACE_SHADER)
    way_from_eye = relative;
#endif
#ifdef MULTISAMPLED
    one = vertex_grid.z;
#endif
#ifdef OVERLAY
    ground_height = height;
#endif
#ifdef HIT
    precise vec2 from_eye_sample = (place - eye_in_tile.xy) - eye_in_tile.zw;
    place_from_eye = from_eye_sample;
    height_and_depth = vec2(height, dot(relative, view_forward.xyz));
#endif
#endif
    set_position(relative);
}
