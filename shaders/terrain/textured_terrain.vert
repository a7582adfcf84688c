#define GROUND
#include "terrain/terrain.vert"
