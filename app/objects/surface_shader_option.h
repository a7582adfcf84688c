#pragma once

#include <optional>
#include <string>

#include "engine/core/result.h"
#include "engine/io/formats/scene_file.h"

namespace CLI {
class App;
}

namespace reljef::app {

/// Parses FILE[:NAME=NUMBERS,...]. Errors name --surface-shader.
Result<io::SurfaceShaderDescription> parse_surface_shader(const std::string& text);

/// The text that parse_surface_shader() reads as this shader.
std::string to_text(const io::SurfaceShaderDescription& shader);

/// Adds --surface-shader. Wrong values throw CLI::ParseError.
void add_surface_shader_option(CLI::App& command,
                               std::optional<io::SurfaceShaderDescription>& shader);

} // namespace reljef::app
