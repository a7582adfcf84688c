#pragma once

#include <string>

namespace reljef::app {

/// "reljef 0.1.0".
std::string version_text();

} // namespace reljef::app
