#include "frame_block.glsl"
#include "tile_vertex.glsl"
