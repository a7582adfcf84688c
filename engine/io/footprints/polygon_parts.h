#pragma once

#include <cstddef>
#include <vector>

#include <ogr_geometry.h>

#include "engine/building/footprint.h"

namespace reljef::io {

/// More corners take minutes.
inline constexpr std::size_t max_polygon_corners = 10'000;

/// The polygons of a geometry, in its own coordinates.
struct PolygonParts {
    std::vector<building::Footprint> parts; ///< filled with triangles
    bool is_polygon = false;                ///< false: it holds points or lines, or nothing
    bool is_repaired = false;               ///< it crossed itself
    std::size_t broken = 0; ///< polygons without area or numbers, or that are too large
};

/// Curves become chords; heights of corners are ignored; what crosses itself is divided as by
/// OGR's MakeValid. Triangles are those of GEOS's constrained Delaunay triangulation.
PolygonParts polygon_parts(const OGRGeometry* geometry);

} // namespace reljef::io
