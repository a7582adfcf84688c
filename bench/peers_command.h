#pragma once

#include "app/cli/command.h"

namespace reljef::bench {

/// `reljef-bench peers`: polygons beside Irrlicht's terrain node.
cli::Command add_peers_command(CLI::App& program, cli::Interrupt& interrupt);

} // namespace reljef::bench
