#pragma once

#include <string>

namespace reljef::cli {

/// "reljef 0.1.0".
std::string version_text();

} // namespace reljef::cli
