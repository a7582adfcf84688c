#pragma once

#include "app/command.h"

namespace reljef::bench {

/// `reljef-bench peers`: polygons beside Irrlicht's terrain node.
app::Command add_peers_command(CLI::App& program, app::Interrupt& interrupt);

} // namespace reljef::bench
