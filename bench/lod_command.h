#pragma once

#include "app/cli/command.h"

namespace reljef::bench {

/// The suite lod: what levels of detail cost, save and do wrong.
cli::Command add_lod_command(CLI::App& program, cli::Interrupt& interrupt);

} // namespace reljef::bench
