#pragma once

#include <string>
#include <string_view>

#include "engine/gl/program.h"

namespace reljef::gl {

/// The driver's compile log in one line, each message with the file and line of `source` in front:
/// "surface.frag:12: error: …; …". Knows the notations of Mesa `0:12(5): …`, NVIDIA `0(12) : …` and
/// `ERROR: 0:12: …`; other lines stay as they are.
std::string readable_log(const StageSource& source, std::string_view log);

} // namespace reljef::gl
