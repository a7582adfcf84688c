layout(std140, binding = 0) uniform FrameBlock {
#include "frame/frame_block.inc"
};
