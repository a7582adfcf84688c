#pragma once

#include "app/command.h"

namespace reljef::bench {

/// `reljef-bench flight`: a flight over a terrain that is read part by part.
app::Command add_flight_command(CLI::App& program, app::Interrupt& interrupt);

} // namespace reljef::bench
