#include "app/program.h"
#include "bench/tables_command.h"

int main(int argc, char** argv) {
    return reljef::app::run_program(
        {.name = "reljef-bench",
         .description = "reljef-bench measures how fast each technique draws a terrain.",
         .verb = "suite",
         .footer = "Examples:\n"
                   "  reljef-bench tables\n"
                   "  reljef-bench tables --quick --json tables.json\n"
                   "'reljef-bench SUITE --help' says more.",
         .commands = {reljef::bench::add_tables_command}},
        argc, argv);
}
