#pragma once

#include <cstddef>
#include <string>

#include "app/viewer/panels/panel_content.h"

namespace reljef::app {

/// "12.3 mm", "4.56 m", "789 m", "12.3 km".
std::string length_text(double metres);

/// "9999", "123.4 k", "1.23 M".
std::string count_text(std::size_t count);

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
