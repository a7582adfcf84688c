#pragma once

#include <array>
#include <string>
#include <vector>

#include "tests/support/test_program.h"

namespace reljef::test {

/// The main function of a program.
using ProgramMain = int (*)(int argc, char** argv);

/// The two ends of what a server is asked through. Programs that are started do not inherit them.
bool make_fork_sockets(std::array<int, 2>& ends);

/// Runs what is asked for at `socket`, each in a fork of this process, until the other end closes.
/// `own` runs where the request names no function.
[[noreturn]] void serve_forks(int socket, ProgramMain own);

/// Runs a program, as run_program does, in a fork of the process that serves the other end of
/// `server`. `program`: a function of that process, or null for its own. `arguments` begin with the
/// program's name. It ends without the destructors of global objects.
ProgramResult run_fork(int server, ProgramMain program, std::vector<std::string> arguments,
                       const ProgramOptions& options);

} // namespace reljef::test
