// reljef-bench-manual FOLDER: writes the manual pages and completions of reljef-bench, when it is
// built.
#include "app/cli/manual.h"
#include "bench/reljef_bench_program.h"

int main(int argc, char** argv) {
    return argc == 2 ? reljef::cli::write_manual(reljef::bench::reljef_bench_program(), argv[1])
                     : 2;
}
