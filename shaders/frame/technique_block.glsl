layout(std140, binding = technique_block_binding) uniform TechniqueBlock {
#include "frame/technique_block.inc"
};
