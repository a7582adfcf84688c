layout(std140, binding = relief_block_binding) uniform ReliefBlock {
#include "frame/relief_block.inc"
};
