#include "tests/bench/bench_program.h"

#include "bench/commands.h"
#include "tests/support/forks/forked_program.h"

namespace reljef::test {
namespace {

int reljef_bench_main(int argc, char** argv) {
    return cli::run_program(bench::reljef_bench_program, argc, argv);
}

} // namespace

ProgramResult reljef_bench(const std::vector<std::string>& arguments) {
    return run_forked(reljef_bench_main, RELJEF_BENCH_BINARY, arguments);
}

} // namespace reljef::test
