#pragma once

#include <vector>

#include "engine/building/building_faces.h"
#include "terrains/urban/urban_city.h"
#include "terrains/urban/urban_tile.h"

namespace reljef::terrains::urban {

/// The buildings of a raster and what stands on their roofs, as City::buildings.
std::vector<building::PaintedFaces> mesh_buildings(const CityPlan& city, const Raster& raster);

} // namespace reljef::terrains::urban
