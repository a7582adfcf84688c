#include "bench/commands.h"

int main(int argc, char** argv) {
    return reljef::cli::run_program(reljef::bench::reljef_bench_program, argc, argv);
}
