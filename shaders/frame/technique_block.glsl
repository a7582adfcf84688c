layout(std140, binding = technique_block_binding) uniform TechniqueBlock {
#include "frame/technique_block.inc"
};
#define shadow_depth option_values.x
#define edge_distance option_values.y
