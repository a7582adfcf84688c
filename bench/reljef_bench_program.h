#pragma once

#include "app/cli/program.h"

namespace reljef::bench {

/// The program `reljef-bench`.
cli::Program reljef_bench_program();

} // namespace reljef::bench
