#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <gdal_priv.h>
#include <glm/vec2.hpp>

#include "engine/io/raster/crs_transform.h"

namespace reljef::io {

/// Maps fractions of a rectangle's sides, 0 to 1, to CRS coordinates.
using PlaceAt = std::function<glm::dvec2(glm::dvec2)>;

/// (longitude, latitude) of 9×9 points from edge to edge of a rectangle; NaN where undefined.
/// Longitudes are continuous around the middle point. `crs` is the CRS of `place_at`. Empty if it
/// does not lead to degrees or the middle point has no position.
std::vector<glm::dvec2> places_over(const PlaceAt& place_at, const std::string& crs);
inline constexpr std::size_t middle_of_places = 40;
/// places_over() an image; empty if it has no place on Earth.
std::vector<glm::dvec2> places_over(GDALDataset& image);

/// Bounding box with a margin for the curved outline between the points.
DegreeBox padded_box(std::span<const glm::dvec2> degrees);

/// The multiples of 360 degrees that move a box onto another.
std::vector<double> turns_to_meet(const DegreeBox& box, const DegreeBox& other);

} // namespace reljef::io
