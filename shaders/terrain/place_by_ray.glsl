// Places are found from the depth along the pixel's ray, not interpolated, see terrain.frag.
#if !defined(GROUND) && !defined(MULTISAMPLED) && !defined(WARPED)
#define PLACE_BY_RAY
#endif
