#pragma once

#include "app/cli/command.h"

namespace reljef::bench {

/// `reljef-bench pareto`.
cli::Command add_pareto_command(CLI::App& program, cli::Interrupt& interrupt);

} // namespace reljef::bench
