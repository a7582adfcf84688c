#pragma once

#include <string>
#include <vector>

#include "engine/core/result.h"
#include "engine/io/formats/scene_file.h"

namespace CLI {
class App;
}

namespace reljef::app {

/// Parses FILE:height=ATTRIBUTE[,roof=flat|hipped] or FILE:surface=TERRAIN[,roof=flat|hipped].
/// Errors name --footprints.
Result<io::FootprintsDescription> parse_footprints(const std::string& text);

/// The text that parse_footprints() reads as these footprints.
std::string to_text(const io::FootprintsDescription& footprints);

/// Adds --footprints, which may be repeated. Wrong values throw CLI::ParseError.
void add_footprints_option(CLI::App& command, std::vector<io::FootprintsDescription>& footprints);

} // namespace reljef::app
