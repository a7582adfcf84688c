#pragma once

#include <string>

namespace reljef::platform {

/// The model of the machine's first processor as Linux names it; "unknown" where it names none.
std::string processor_name();

} // namespace reljef::platform
