#pragma once

#include <ogr_geometry.h>

#include "engine/io/raster/crs_transform.h"

namespace reljef::io {

/// Transforms the corners of all polygons in place to longitudes and latitudes of WGS 84, degrees.
/// The longitudes of a polygon go on beyond ±180 instead of around the Earth. False if a corner has
/// no place on Earth.
bool place_on_earth(OGRGeometry& geometry, const CrsTransform& transform);

} // namespace reljef::io
