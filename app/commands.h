#pragma once

#include "app/cli/program.h"

namespace reljef::app {

cli::Command add_view_command(CLI::App& program, cli::Interrupt& interrupt);
cli::Command add_render_command(CLI::App& program, cli::Interrupt& interrupt);
cli::Command add_info_command(CLI::App& program, cli::Interrupt& interrupt);
cli::Command add_height_command(CLI::App& program, cli::Interrupt& interrupt);
cli::Command add_index_command(CLI::App& program, cli::Interrupt& interrupt);
cli::Command add_maps_command(CLI::App& program, cli::Interrupt& interrupt);
cli::Command add_profile_command(CLI::App& program, cli::Interrupt& interrupt);
cli::Command add_viewshed_command(CLI::App& program, cli::Interrupt& interrupt);
cli::Command add_techniques_command(CLI::App& program, cli::Interrupt& interrupt);

cli::Program reljef_program();

} // namespace reljef::app
