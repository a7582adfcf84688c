// Where a triangle covers part of a pixel with several samples, its values are taken inside that part:
// beyond its border they are none of its own, and of one seen edge-on far from them. Where each sample
// is shaded by itself (PER_SAMPLE), they are taken there.
#ifdef MULTISAMPLED
// 1 everywhere. Mesa's software renderer divides by the w of the pixel's centre whatever it
// interpolates elsewhere, and so by this again.
in float one;
#endif

#if defined(MULTISAMPLED) && defined(PER_SAMPLE)
#define INSIDE(value) ((value) / one)
#define FROM_PIXEL_TO_PIXEL(value) INSIDE(value)
#elif defined(MULTISAMPLED)
#define INSIDE(value) (interpolateAtCentroid(value) / interpolateAtCentroid(one))
#define FROM_PIXEL_TO_PIXEL(value) (value) // for derivatives: always at the centres
#else
#define INSIDE(value) (value)
#define FROM_PIXEL_TO_PIXEL(value) (value)
#endif
