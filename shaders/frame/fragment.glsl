// Multisampling: interpolates at the covered part of a pixel, because extrapolated values of a triangle
// seen edge-on are far off. With PER_SAMPLE the inputs already belong to the sample.
#if defined(MULTISAMPLED) && !defined(SLIVER)
// Always 1. Mesa's software renderer divides by the w of the pixel's centre wherever it interpolates;
// dividing by this corrects it.
in float one;
#endif

#ifdef SLIVER // not interpolated
#define INSIDE(value) (value)
#define FROM_PIXEL_TO_PIXEL(value) (value)
#elif defined(MULTISAMPLED) && defined(PER_SAMPLE)
#define INSIDE(value) ((value) / one)
#define FROM_PIXEL_TO_PIXEL(value) INSIDE(value)
#elif defined(MULTISAMPLED)
#define INSIDE(value) (interpolateAtCentroid(value) / interpolateAtCentroid(one))
#define FROM_PIXEL_TO_PIXEL(value) (value) // for derivatives: at the centres
#else
#define INSIDE(value) (value)
#define FROM_PIXEL_TO_PIXEL(value) (value)
#endif
