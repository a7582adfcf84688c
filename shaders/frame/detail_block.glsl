layout(std140, binding = detail_block_binding) uniform DetailBlock {
#include "frame/detail_block.inc"
};
#define lift detail_heights.x
#define mesh_height detail_heights.y
#define normal_scale detail_heights.z
#define side detail_heights.w
#define repeats detail_repeats.xy
#define tile_width detail_repeats.z
#define bounded detail_repeats.w
#define shine detail_look.xy
#define rms_rise detail_look.zw
