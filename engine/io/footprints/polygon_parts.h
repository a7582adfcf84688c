#pragma once

#include <cstddef>
#include <vector>

#include <ogr_geometry.h>

#include "engine/building/footprint.h"
#include "engine/io/footprints/footprint_file.h"

namespace reljef::io {

/// The polygons of a geometry, in its own coordinates.
struct PolygonParts {
    std::vector<building::Footprint> parts; ///< filled with triangles
    bool is_repaired = false;  ///< a polygon was not valid: it crossed itself, or a hole its border
    std::size_t broken = 0;    ///< polygons without area or numbers
    std::size_t too_large = 0; ///< polygons of over max_polygon_corners
};

/// Whether the geometry is or holds a polygon, and no points or lines alone.
bool has_polygon(const OGRGeometry& geometry);

/// Heights of corners are ignored. What is not valid is repaired as by GEOS's MakeValid by
/// structure: outlines that cross themselves are divided, holes take away what they cover.
/// Triangles are those of GEOS's constrained Delaunay triangulation. Precondition: no curves.
PolygonParts polygon_parts(const OGRGeometry& geometry);

} // namespace reljef::io
