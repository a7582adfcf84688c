// Rays over the curved Earth: in the search space they are bent. `part` counts from their start to their end.
layout(std140, binding = course_block_binding) uniform CourseBlock {
#include "frame/course_block.inc"
};

#ifdef DEGREES
#include "curved/degree_rays.glsl"
#else
#include "curved/polynomial_rays.glsl"
#endif

vec2 curve_range = vec2(0.0, 1.0); // parts of this fragment's ray that are searched

// The first hit between two parts. `above`: the ray comes from above the search space.
bool find_between(vec2 range, bool above, out float part, out vec2 place);
