#pragma once

#include "app/cli/program.h"

namespace reljef::app {

cli::Command add_calibrate_command(CLI::App& program, cli::Interrupt& interrupt);

} // namespace reljef::app
