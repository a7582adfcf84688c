#pragma once

#include <functional>
#include <optional>
#include <span>

#include <glm/vec2.hpp>

#include "engine/geo/georeference.h"

namespace reljef::io {

/// Turns (col, row) into the exact (latitude, longitude), degrees, in place; false where one of
/// them has none.
using ExactPositions = std::function<bool(std::span<glm::dvec2> samples)>;

/// An error that a fitted map may have, metres.
inline constexpr double map_tolerance = 1e-4;

struct GeodeticFit {
    geo::GeodeticMap map;
    double error =
        0.0; ///< largest found against the exact transform between control points, metres
};

/// A map over cols×rows samples with as many control points, 9 to 257 a side, as its error needs to
/// stay within map_tolerance; the best there is where none does. Nothing where the exact transform
/// fails for part of the raster.
std::optional<GeodeticFit> fit_geodetic_map(const ExactPositions& exact, int cols, int rows);

} // namespace reljef::io
