#pragma once

#include <optional>
#include <string>
#include <vector>

#include <gdal_priv.h>
#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>

#include "engine/io/imagery/imagery_set.h"
#include "engine/io/raster/crs_transform.h"

namespace reljef::io {

/// Places a raster in the ground's coordinates. False if GDAL fails.
bool place_over(const ImageryGround& ground, const geo::PixelAffine& affine, GDALDataset& raster);

/// Maps corner pixels of an image of `size` to corner samples of the ground.
geo::PixelAffine stretched_over(const ImageryGround& ground, glm::ivec2 size);

/// Bounding box of a placed raster, with a margin for the curved outline between 9×9 points.
/// Longitudes are continuous around the middle, which may lie beyond ±180. Absent if its CRS does
/// not lead to degrees or its middle has no position.
std::optional<DegreeBox> degree_box(GDALDataset& raster);

/// The multiples of 360 degrees that move a box onto another.
std::vector<double> turns_to_meet(const DegreeBox& box, const DegreeBox& other);

/// Units of x per degree; 0 if a CRS is not in degrees.
double units_in_degree(const std::string& crs);

/// Steps of an image's column and row in the ground's coordinates, near the ground's middle. Absent
/// if its CRS does not lead to the ground's.
std::optional<glm::dmat2> steps_over(const ImageryGround& ground, GDALDataset& image);

} // namespace reljef::io
