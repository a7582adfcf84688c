#include "bench/commands.h"

namespace reljef::bench {

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
            .commands = {add_tables_command, add_pareto_command, add_lod_command, add_peers_command,
                         add_flight_command, add_skip_command, add_objects_command,
                         add_stress_command, add_compare_command, add_findings_command}};
}

} // namespace reljef::bench
