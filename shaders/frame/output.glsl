#ifdef HIT
layout(location = 0) out vec4 hit;     // col, row, height, depth
layout(location = 1) out vec2 hit_low; // to be added to col, row
#elif defined(COUNT)
layout(location = 0) out vec4 work; // taps, steps, rays, fragments
vec4 color;
#else
layout(location = 0) out vec4 color;
#endif
