#pragma once

#include <string>
#include <vector>

#include "engine/core/result.h"
#include "engine/io/formats/scene_file.h"

namespace CLI {
class App;
}

namespace reljef::app {

/// Parses FILE:at=LAT,LON[,height=M][,heading=DEG][,scale=S], or FILE alone. Errors name --object.
Result<io::ObjectDescription> parse_object(const std::string& text);

/// The text that parse_object() reads as this object.
std::string to_text(const io::ObjectDescription& object);

/// Adds --object and --footprints, which may be repeated. Wrong values throw CLI::ParseError.
void add_object_options(CLI::App& command, std::vector<io::ObjectDescription>& objects,
                        std::vector<io::FootprintsDescription>& footprints);

} // namespace reljef::app
