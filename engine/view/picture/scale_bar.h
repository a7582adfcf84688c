#pragma once

#include <string>

namespace reljef::view {

/// A bar of a round length: 1, 2 or 5 times a power of ten.
struct ScaleBar {
    double metres = 0.0;
    double pixels = 0.0;
};

/// The longest bar of at most `max_pixels`. Preconditions: both are over 0.
ScaleBar scale_bar(double metres_per_pixel, double max_pixels);

/// The smallest round number of at least `min`. Precondition: it is over 0.
double round_step(double min);

/// With as many digits as a multiple of the round number `step` needs.
std::string text_of_multiple(double number, double step);

/// "500 m", "2 km". Precondition: the length is round.
std::string bar_text(double metres);

} // namespace reljef::view
