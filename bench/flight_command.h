#pragma once

#include "app/cli/command.h"

namespace reljef::bench {

/// `reljef-bench flight`: a flight over a terrain that is read part by part.
cli::Command add_flight_command(CLI::App& program, cli::Interrupt& interrupt);

} // namespace reljef::bench
