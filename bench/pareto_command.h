#pragma once

#include "app/command.h"

namespace reljef::bench {

/// `reljef-bench pareto`.
app::Command add_pareto_command(CLI::App& program, app::Interrupt& interrupt);

} // namespace reljef::bench
