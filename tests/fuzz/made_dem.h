#pragma once

#include <string>

namespace reljef::fuzz {

/// An ASCII grid of hills, `side` samples a side, on degrees at 45 north, 6 east.
std::string made_dem(int side);

} // namespace reljef::fuzz
