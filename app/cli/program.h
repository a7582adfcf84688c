#pragma once

#include <string>
#include <vector>

#include "app/cli/command.h"

namespace reljef::cli {

struct Program {
    std::string name; ///< of the file; messages begin with it
    std::string description;
    std::string verb; ///< the word for its verbs
    std::string footer;
    std::vector<Command (*)(CLI::App&, Interrupt&)> commands;
};

/// "reljef 0.1.0".
std::string version_text();

/// Parses the arguments and runs their verb. Errors are one line on stderr. Returns the exit
/// status: 0, 1 if the verb failed, was interrupted or could not write its output, 2 after wrong
/// arguments.
int run_program(Program (*make)(), int argc, char** argv) noexcept;

} // namespace reljef::cli
