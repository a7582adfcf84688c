#include "bench/commands.h"

#include <memory>
#include <sstream>
#include <string>
#include <utility>

namespace reljef::bench {
namespace {

// Writes each line of a verb's error as an error: of many inputs, each has its own (Problems).
cli::Command with_errors_in_lines(cli::Command command) {
    const auto has_written = std::make_shared<bool>(false);
    const auto run = [run = std::move(command.run), has_written]() -> Result<void> {
        auto done = run();
        if (!done && done.error().message.find('\n') != std::string::npos) {
            std::istringstream lines(done.error().message);
            for (std::string line; std::getline(lines, line);) {
                cli::write_error("reljef-bench", {line, done.error().kind});
            }
            *has_written = true;
        }
        return done;
    };
    return {command.arguments, run, [has_written] { return *has_written; }};
}

template <auto add> cli::Command added(CLI::App& program, cli::Interrupt& interrupt) {
    return with_errors_in_lines(add(program, interrupt));
}

} // namespace

cli::Program reljef_bench_program() {
    return {.name = "reljef-bench",
            .description =
                "reljef-bench measures the frame time and the error of each technique, and its "
                "numerical stability.",
            .verb = "suite",
            .footer = "Examples:\n"
                      "  reljef-bench tables --quick --json tables.json\n"
                      "  reljef-bench pareto --terrain natural\n"
                      "  reljef-bench lod --terrain natural\n"
                      "  reljef-bench skip --quick --html report\n"
                      "  reljef-bench objects --quick\n"
                      "  reljef-bench stress --quick\n"
                      "  reljef-bench compare before.json after.json\n"
                      "  reljef-bench findings --markdown docs/findings.md\n"
                      "'reljef-bench SUITE --help' lists the options of a suite.",
            .commands = {added<add_tables_command>, added<add_pareto_command>,
                         added<add_lod_command>, added<add_peers_command>,
                         added<add_flight_command>, added<add_skip_command>,
                         added<add_objects_command>, added<add_stress_command>,
                         added<add_compare_command>, added<add_findings_command>}};
}

} // namespace reljef::bench
