#ifdef HIT
layout(location = 0) out vec4 hit;     // col, row, height, depth
layout(location = 1) out vec2 hit_low; // to be added to col, row
#else
layout(location = 0) out vec4 color;
#endif
