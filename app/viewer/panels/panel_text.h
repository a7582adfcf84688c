#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "app/viewer/panels/panel_content.h"

namespace reljef::app {

/// "12.3 mm", "4.56 m", "789 m", "12.3 km".
std::string length_text(double metres);

/// "9999", "123.4 k", "1.23 M".
std::string count_text(std::size_t count);

/// With four digits, and more before the point: "4.148", "16384".
std::string short_number(double value);

/// As on the command line, with four digits of each number: "polygons:error=4.148".
std::string short_text(const scene::Technique& technique);

/// The technique of the scene, or "torus: relief" of the selected model, short.
std::string technique_summary(const TechniqueContent& content);

/// A round number on an axis.
struct AxisTick {
    double value = 0.0;
    std::string text; ///< with as many digits as all ticks need
};
/// Round numbers at equal distances from `low` to `high`, at most about `max_count` of them.
/// Precondition: low < high, and both are finite.
std::vector<AxisTick> axis_ticks(double low, double high, double max_count);

/// How the position bar writes places.
enum class PlaceFormat { geographic, mgrs, crs, scene };

/// The next format that the place has.
PlaceFormat next_format(PlaceFormat format, const PlaceContent& place);

/// A place without its height: "46.12345° N 7.12345° E", a MGRS square, CRS or scene coordinates. A
/// format that the place lacks is replaced by scene metres.
std::string place_text(const PlaceContent& place, PlaceFormat format);

/// "never more than 1.0 px off", or what else is known of the frame's error.
std::string error_summary(const view::FrameStats& stats, const scene::Technique& technique);

/// "9 tiles, rays for 40 %", "triangles" or "rays".
std::string choice_summary(const view::Choice& choice);

} // namespace reljef::app
