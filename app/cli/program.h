#pragma once

#include <string>
#include <vector>

#include "app/cli/command.h"

namespace reljef::cli {

/// A program of several verbs.
struct Program {
    std::string name; ///< as it is called; messages begin with it
    std::string description;
    std::string verb; ///< what its verbs are called
    std::string footer;
    std::vector<Command (*)(CLI::App&, Interrupt&)> commands;
};

/// Parses the arguments and runs the verb they name. What is wrong is told in one line on stderr.
/// Returns the exit status: 0, 1 where the verb failed, was interrupted or its output could not be
/// written, 2 where it was misused. The program's help says so.
int run_program(const Program& program, int argc, char** argv) noexcept;

} // namespace reljef::cli
