#include "tests/bench/bench_program.h"

namespace reljef::test {

ProgramResult reljef_bench(const std::vector<std::string>& arguments) {
    return run_program(RELJEF_BENCH_BINARY, arguments);
}

} // namespace reljef::test
