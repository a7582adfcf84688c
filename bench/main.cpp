#include <algorithm>
#include <array>
#include <string_view>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/version.h"
#include "bench/tables_command.h"

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
    fmt::print(stderr, "reljef-bench: {} (see --help)\n", message);
    return misused;
}

// Throws where the first argument is meant to name a suite and does not.
void check_suite(int argc, char** argv, const std::vector<const CLI::App*>& suites) {
    const std::string_view found = argc > 1 ? argv[1] : "";
    std::string expected;
    for (const CLI::App* suite : suites) {
        if (suite->get_name() == found || found.starts_with('-')) {
            return;
        }
        expected += (expected.empty() ? "" : ", ") + suite->get_name();
    }
    throw CLI::ValidationError(
        fmt::format("suite '{}' found, one of {} was expected", found, expected));
}

int run(int argc, char** argv) {
    reljef::app::Interrupt interrupt;
    CLI::App program{"reljef-bench measures how fast each technique draws a terrain."};
    program.set_version_flag("--version", reljef::app::version_text());
    program.require_subcommand(1);
    program.footer("Examples:\n"
                   "  reljef-bench tables\n"
                   "  reljef-bench tables --quick --json tables.json\n"
                   "'reljef-bench SUITE --help' says more.");
    const std::array commands{reljef::bench::add_tables_command(program, interrupt)};
    try {
        std::vector<const CLI::App*> suites;
        suites.reserve(commands.size());
        for (const auto& command : commands) {
            suites.push_back(command.arguments);
        }
        check_suite(argc, argv, suites);
        program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return explain(program, error);
    }
    for (const auto& command : commands) {
        if (!command.arguments->parsed()) {
            continue;
        }
        if (const auto done = command.run(); !done) {
            fmt::print(stderr, "reljef-bench: {}\n", done.error().message);
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
        fmt::print(stderr, "reljef-bench: {}\n", error.what());
        return failed;
    }
}
