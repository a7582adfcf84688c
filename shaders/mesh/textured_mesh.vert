#include "frame/frame_block.glsl"
#include "material/tile_vertex.glsl"
