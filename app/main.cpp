#include <array>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/command.h"
#include "app/version.h"

namespace {

constexpr int failed = 1;
constexpr int misused = 2;

// One line for whatever is wrong with the arguments; help and version are no mistakes.
int explain(const CLI::App& program, const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
        return program.exit(error);
    }
    std::string message = error.what();
    std::replace(message.begin(), message.end(), '\n', ' ');
    fmt::print(stderr, "reljef: {} (see --help)\n", message);
    return misused;
}

int run(int argc, char** argv) {
    using namespace reljef::app;
    Interrupt interrupt;
    CLI::App program{"reljef draws terrain, fast, and says how wrong each picture is."};
    program.set_version_flag("--version", version_text());
    program.require_subcommand(1);
    program.footer("Examples:\n"
                   "  reljef view natural\n"
                   "  reljef render N45E006.hgt -o alps.png\n"
                   "  reljef render urban --path orbit --frames 100 -o flight.mp4\n"
                   "  reljef info N45E006.hgt --json\n"
                   "  reljef height N45E006.hgt --at 45.8326,6.8652\n"
                   "'reljef VERB --help' says more.");
    const std::array commands{
        add_view_command(program, interrupt), add_render_command(program, interrupt),
        add_info_command(program, interrupt), add_height_command(program, interrupt),
        add_techniques_command(program, interrupt)};
    try {
        program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return explain(program, error);
    }
    for (const Command& command : commands) {
        if (!command.arguments->parsed()) {
            continue;
        }
        if (const auto done = command.run(); !done) {
            fmt::print(stderr, "reljef: {}\n",
                       interrupt.requested() ? "interrupted" : done.error().message);
            return failed;
        }
    }
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const std::exception& error) {
        fmt::print(stderr, "reljef: {}\n", error.what());
        return failed;
    }
}
