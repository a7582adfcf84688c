#pragma once

#include "app/command.h"

namespace reljef::bench {

/// The suite lod: what levels of detail cost, save and do wrong.
app::Command add_lod_command(CLI::App& program, app::Interrupt& interrupt);

} // namespace reljef::bench
