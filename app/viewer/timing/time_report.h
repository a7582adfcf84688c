#pragma once

#include <string>

#include "app/viewer/timing/viewer_times.h"

namespace reljef::app {

/// Lines of a table, for people; kinds without times are left out.
std::string text_of(const TimeReport& report);

/// An object with "first_picture_s", "complete_picture_s" (null: never shown) and one member for
/// each row: "count", and, unless it is 0, "median_ms", "p99_ms", "max_ms", of answers
/// "max_frames".
std::string json_of(const TimeReport& report);

} // namespace reljef::app
