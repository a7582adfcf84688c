// reljef-bench-manual FOLDER: writes the manual pages and completions of reljef-bench.
#include "app/cli/manual.h"
#include "bench/commands.h"

int main(int argc, char** argv) {
    return argc == 2 ? reljef::cli::write_manual(reljef::bench::reljef_bench_program(), argv[1])
                     : 2;
}
