#include "app/cli/program.h"
#include "bench/compare_command.h"
#include "bench/flight_command.h"
#include "bench/lod_command.h"
#include "bench/pareto_command.h"
#include "bench/peers_command.h"
#include "bench/tables_command.h"

int main(int argc, char** argv) {
    namespace bench = reljef::bench;
    return reljef::cli::run_program(
        {.name = "reljef-bench",
         .description = "reljef-bench measures how fast each technique draws a terrain, and how "
                        "wrong its picture is.",
         .verb = "suite",
         .footer = "Examples:\n"
                   "  reljef-bench tables --quick --json tables.json\n"
                   "  reljef-bench pareto --terrain natural\n"
                   "  reljef-bench lod --terrain natural\n"
                   "  reljef-bench compare before.json after.json\n"
                   "'reljef-bench SUITE --help' says more.",
         .commands = {bench::add_tables_command, bench::add_pareto_command, bench::add_lod_command,
                      bench::add_peers_command, bench::add_flight_command,
                      bench::add_compare_command}},
        argc, argv);
}
