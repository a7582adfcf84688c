#pragma once

#include "app/command.h"

namespace reljef::bench {

/// `reljef-bench tables`.
app::Command add_tables_command(CLI::App& program, app::Interrupt& interrupt);

} // namespace reljef::bench
