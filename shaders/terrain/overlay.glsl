// What is drawn over ground: its grain and contours.
layout(std140, binding = overlay_block_binding) uniform OverlayBlock {
#include "frame/overlay_block.inc"
};
#include "terrain/grain.glsl"
#include "terrain/contours.glsl"
