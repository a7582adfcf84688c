#pragma once

#include "app/cli/options.h"

namespace reljef::app {

/// --show: `shows_choice` becomes true for false colours of what `auto` draws.
void add_show_option(CLI::App& command, bool& shows_choice);

/// Throws CLI::ParseError if the choice is shown and nothing chooses. For the command's callback.
void expect_choice(bool shows_choice, const cli::ViewChoice& view, bool draws_truth);

} // namespace reljef::app
