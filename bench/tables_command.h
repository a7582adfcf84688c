#pragma once

#include "app/cli/command.h"

namespace reljef::bench {

/// `reljef-bench tables`.
cli::Command add_tables_command(CLI::App& program, cli::Interrupt& interrupt);

} // namespace reljef::bench
