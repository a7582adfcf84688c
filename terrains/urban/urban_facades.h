#pragma once

#include "engine/terrain/field/facades.h"
#include "terrains/urban/urban_city.h"
#include "terrains/urban/urban_tile.h"

namespace reljef::terrains::urban {

/// The walls of the buildings that a raster shows as heights.
terrain::Facades facades_of(const CityPlan& city, const Raster& raster);

} // namespace reljef::terrains::urban
