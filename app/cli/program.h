#pragma once

#include <functional>
#include <string>
#include <string_view>
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
    /// Whether run() wrote its error itself, by write_error(); empty: it never does.
    std::function<bool()> has_written_error = {};
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

/// Writes an error to stderr, as one line that begins with the name of the program.
void write_error(std::string_view program, const Error& error);

/// Parses the arguments and runs their verb. Errors are one line on stderr. Returns the exit
/// status: 0, 1 if the verb failed, was interrupted or could not write its output, 2 after wrong
/// arguments.
int run_program(Program (*make)(), int argc, char** argv) noexcept;

} // namespace reljef::cli
