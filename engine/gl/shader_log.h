#pragma once

#include <string>
#include <string_view>

#include "engine/gl/program.h"

namespace reljef::gl {

/// The driver's compile log on one line, each message after its file and line:
/// "surface.frag:12: error: …; …". Parses the notations of Mesa `0:12(5): …`, NVIDIA `0(12) : …`
/// and `ERROR: 0:12: …`; other lines stay unchanged.
std::string readable_log(const StageSource& source, std::string_view log);

} // namespace reljef::gl
