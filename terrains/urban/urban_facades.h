#pragma once

#include "engine/terrain/field/facades.h"
#include "terrains/urban/urban_city.h"
#include "terrains/urban/urban_tile.h"

namespace reljef::terrains::urban {

/// The walls of the buildings that a raster shows as heights. `planted`: samples of what stands
/// before them.
terrain::Facades facades_of(const CityPlan& city, const Raster& raster,
                            GridView<const float> heights, const Grid<std::uint8_t>& planted);

} // namespace reljef::terrains::urban
