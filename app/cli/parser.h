#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "app/cli/program.h"

namespace reljef::cli {

class Parser {
public:
    /// `interrupt` outlives this.
    Parser(const Program& program, Interrupt& interrupt);
    ~Parser();

    [[nodiscard]] const CLI::App& arguments() const { return *arguments_; }
    [[nodiscard]] const std::vector<Command>& commands() const { return commands_; }

    /// Parses the arguments after the program's name and returns their verb. Throws
    /// CLI::ParseError, also for help and version.
    const Command& parse(std::span<char*> texts);

private:
    void check_verb(std::span<char*> texts) const;
    [[nodiscard]] const Command* named(std::string_view verb) const;

    const Program& program_;
    std::unique_ptr<CLI::App> arguments_;
    std::vector<Command> commands_;
};

} // namespace reljef::cli
