#pragma once

#include <string>
#include <vector>

#include "engine/core/result.h"
#include "engine/io/formats/scene_file.h"

namespace CLI {
class App;
}

namespace reljef::app {

/// Parses AT[:height=M][,intensity=I][,range=M][,color=#RRGGBB]. Errors name --point-light.
Result<io::PointLightDescription> parse_point_light(const std::string& text);

/// The text that parse_point_light() reads as this light.
std::string to_text(const io::PointLightDescription& light);

/// Adds --point-light, which may be repeated. Wrong values throw CLI::ParseError.
void add_point_light_option(CLI::App& command, std::vector<io::PointLightDescription>& lights);

} // namespace reljef::app
