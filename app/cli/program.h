#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/cli/interrupt.h"
#include "engine/core/result.h"

namespace CLI {
class App;
}

namespace reljef::cli {

/// A verb of the program.
struct Command {
    CLI::App* arguments = nullptr;     ///< owned by the program's parser
    std::function<Result<void>()> run; ///< after parsing
};

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
