#pragma once

#include "app/command.h"

namespace reljef::bench {

/// `reljef-bench compare`.
app::Command add_compare_command(CLI::App& program, app::Interrupt& interrupt);

} // namespace reljef::bench
