#pragma once

#include "app/cli/command.h"

namespace reljef::bench {

/// `reljef-bench compare`.
cli::Command add_compare_command(CLI::App& program, cli::Interrupt& interrupt);

} // namespace reljef::bench
