#pragma once

#include "bench/results.h"

namespace reljef::test {

/// A run on the scene `scene`: texture, polygons that take four times as long, and the null row.
bench::Results made_results(const std::string& scene = "natural");

} // namespace reljef::test
