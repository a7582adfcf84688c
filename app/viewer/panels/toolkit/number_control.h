#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "engine/core/geometry.h"

namespace reljef::app {

/// A number that one types into a box, or moves with a slider.
struct NumberControl {
    Interval slider;                    ///< its ends
    std::optional<Interval> typed = {}; ///< allowed in the box; absent: those of the slider
    std::optional<int> decimals = 2;    ///< of what the slider gives; absent: all
    bool is_logarithmic = false;        ///< the slider
    std::string_view unit = {};         ///< behind the box
    std::string_view meaning = {};      ///< the tip
};

/// The number without trailing zeros, with at most `decimals` decimals.
std::string number_text(double value, int decimals);

/// A name at the left and the number's box at the right, with a slider below. A click into the box
/// lets one type, and so does a double click or Ctrl+click on the slider; Enter or a click
/// elsewhere ends it. Returns the new number if the user changes it: as typed, or rounded from the
/// slider.
std::optional<double> number_row(const char* name, const NumberControl& control, double value);

/// The same parts one by one, for other rows. Within the same ImGui ID.
/// The box: the number as typed.
std::optional<double> number_box(const std::string& shown, float width, std::string_view meaning);
/// The slider over the whole width: the number as moved, rounded. A double click gives the number
/// of before it, which the box then has.
std::optional<double> number_slider(const NumberControl& control, double value);
/// The width of a box, pixels.
float number_box_width();

} // namespace reljef::app
