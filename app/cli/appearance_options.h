#pragma once

#include "engine/session/options.h"

namespace CLI {
class App;
}

namespace reljef::cli {

/// Adds the options of sun, air and sky, and of what is drawn over the ground. Wrong values throw
/// CLI::ParseError.
void add_appearance_options(CLI::App& command, session::SceneOptions& choice);

} // namespace reljef::cli
