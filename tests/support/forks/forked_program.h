#pragma once

#include <string>
#include <vector>

#include "tests/support/forks/fork_server.h"
#include "tests/support/test_program.h"

namespace reljef::test {

/// Runs a program whose code is linked into the tests as run_program runs a program, in a process
/// of its own. The process is a fork of one that exists since before the first test: its libraries
/// are loaded already, which takes the linker longer than most runs, and nothing of it has begun.
/// It ends without the destructors of global objects.
ProgramResult run_forked(ProgramMain program, const std::string& name,
                         const std::vector<std::string>& arguments,
                         const ProgramOptions& options = {});

} // namespace reljef::test
