#pragma once

#include <string>

#include "bench/findings/committed_results.h"
#include "engine/core/result.h"

namespace reljef::bench {

/// Where in docs the plot lies that the page of findings shows.
inline constexpr const char* distance_plot_file = "pictures/distance.svg";

/// An SVG: error in pixels and time of a frame over the distance of the eye from a city, for a
/// plain texture, parallax, relief and, of times, objects. Figures that were not measured are left
/// out. Fails as CommittedResults::number.
Result<std::string> distance_plot(const CommittedResults& results);

} // namespace reljef::bench
