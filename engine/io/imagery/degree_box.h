#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/io/raster/crs_transform.h"

namespace reljef::io {

/// From parts of a rectangle's sides, 0 to 1, to places.
using PlaceAt = std::function<glm::dvec2(glm::dvec2)>;

/// Places from edge to edge of a rectangle, 9×9, longitude and latitude, longitudes running on from
/// the middle one's; NaN where there is none. `crs`: what `place_at` gives places in. Empty where
/// there is no way from it to degrees.
std::vector<glm::dvec2> places_over(const PlaceAt& place_at, const std::string& crs);
inline constexpr std::size_t middle_of_places = 40;

/// Around places, with a margin: between those that make it the outline may bulge.
DegreeBox padded_box(std::span<const glm::dvec2> degrees);

/// By how many degrees a box is to be moved so that it meets another, for each whole turn.
std::vector<double> turns_to_meet(const DegreeBox& box, const DegreeBox& other);

} // namespace reljef::io
