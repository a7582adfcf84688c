#pragma once

#include "app/cli/program.h"

namespace reljef::bench {

/// The program `reljef-bench` with all its subcommands.
cli::Program reljef_bench_program();

cli::Command add_tables_command(CLI::App& program, cli::Interrupt& interrupt);
cli::Command add_pareto_command(CLI::App& program, cli::Interrupt& interrupt);
cli::Command add_lod_command(CLI::App& program, cli::Interrupt& interrupt);
cli::Command add_peers_command(CLI::App& program, cli::Interrupt& interrupt);
cli::Command add_flight_command(CLI::App& program, cli::Interrupt& interrupt);
cli::Command add_skip_command(CLI::App& program, cli::Interrupt& interrupt);
cli::Command add_objects_command(CLI::App& program, cli::Interrupt& interrupt);
cli::Command add_stress_command(CLI::App& program, cli::Interrupt& interrupt);
cli::Command add_findings_command(CLI::App& program, cli::Interrupt& interrupt);
cli::Command add_compare_command(CLI::App& program, cli::Interrupt& interrupt);

} // namespace reljef::bench
