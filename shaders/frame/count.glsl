// The work of a fragment. Only variants that count have it.
#ifdef COUNT
float work_taps = 0.0;  // texture instructions
float work_steps = 0.0; // of searches along rays
float work_rays = 0.0;  // that search

void count_taps(float taps) {
    work_taps += taps;
}

void count_step() {
    work_steps += 1.0;
}

void count_ray() {
    work_rays += 1.0;
}
#else
#define count_taps(taps)
#define count_step()
#define count_ray()
#endif
