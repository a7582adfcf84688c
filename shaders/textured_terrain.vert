#define GROUND
#include "terrain.vert"
