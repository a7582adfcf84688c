#include "frame/bindings.inc"
layout(std140, binding = frame_block_binding) uniform FrameBlock {
#include "frame/frame_block.inc"
};
#define perspective projection.x
#define near_depth projection.y
#define metres_a_pixel projection.zw
