#include "frame_block.glsl"

layout(location = 0) in vec3 position; // metres from the tile's origin
layout(location = 1) in vec2 place;    // samples from the tile's first
#ifdef HIT
layout(location = 2) in float height; // true metres
#endif

uniform mat4 relative_from_tile; // world directions relative to the eye, metres

out vec2 tile_place; // samples from the tile's first
#ifdef HIT
out vec2 height_and_depth; // true metres; metres along the view axis
#endif

void main() {
    vec4 relative = relative_from_tile * vec4(position, 1.0);
    tile_place = place;
#ifdef HIT
    height_and_depth = vec2(height, dot(relative.xyz, view_forward.xyz));
#endif
    gl_Position = clip_from_relative * relative;
}
