#pragma once

#include <string>
#include <vector>

#include "engine/core/result.h"
#include "engine/io/formats/scene_file.h"

namespace CLI {
class App;
}

namespace reljef::app {

/// Parses AZIMUTH,ALTITUDE[:intensity=I][,color=#RRGGBB]. Errors name --light.
Result<io::LightDescription> parse_light(const std::string& text);

/// The text that parse_light() reads as this light.
std::string to_text(const io::LightDescription& light);

/// Adds --light, which may be repeated. Wrong values throw CLI::ParseError.
void add_light_option(CLI::App& command, std::vector<io::LightDescription>& lights);

} // namespace reljef::app
