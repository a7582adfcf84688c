#include "app/cli/program.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <new>
#include <span>
#include <string_view>

#include <CLI/CLI.hpp>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "app/cli/message.h"
#include "app/cli/version.h"

namespace reljef::cli {
namespace {

constexpr int done = 0;
constexpr int failed = 1;
constexpr int misused = 2;
constexpr const char* status_help =
    "Exit status: 0 done; 1 failed, or ended by Ctrl-C (SIGINT, SIGTERM or SIGHUP); 2 misused: "
    "what was\nasked for is unknown or does not go together, and nothing was written. A second "
    "signal, half a second\nlater, ends at once, with 128 and its number.";

// A stream that was closed would be the next file opened, and be written into. What is opened in
// its place cannot be written, so that output that is lost is told.
void keep_streams_open() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (::fcntl(stream, F_GETFD) == -1) {
            static_cast<void>(::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY));
        }
    }
}

// What the parser library would let pass: an empty value, or take for something else.
void check_texts(std::span<char*> texts) {
    for (std::size_t i = 0; i < texts.size(); ++i) {
        const std::string_view text = texts[i];
        if (text.empty()) {
            throw CLI::ValidationError(
                i == 0 ? std::string("an empty word found, a word was expected")
                       : fmt::format("an empty word found after '{}', a word was expected",
                                     texts[i - 1]));
        }
        if (text.starts_with("--") && text.ends_with("=")) {
            throw CLI::ValidationError(
                fmt::format("{} found, a value was expected after it", text));
        }
    }
}

// What is meant to name a verb must do so.
void check_verb(std::span<char*> texts, const Program& program,
                const std::vector<Command>& commands) {
    const std::string_view found = texts.empty() ? "" : texts[0];
    std::string expected;
    for (const Command& command : commands) {
        if (command.arguments->get_name() == found || found.starts_with('-')) {
            return;
        }
        expected += (expected.empty() ? "" : ", ") + command.arguments->get_name();
    }
    throw CLI::ValidationError(
        texts.empty()
            ? fmt::format("no {} found, one of {} was expected", program.verb, expected)
            : fmt::format("{} '{}' found, one of {} was expected", program.verb, found, expected));
}

// One line of all, as what a shader's compiler has to say may have many.
std::string one_line(std::string_view message) {
    std::string line;
    for (std::size_t begin = 0; begin < message.size();) {
        const std::size_t end = std::min(message.find('\n', begin), message.size());
        line += (begin > 0 ? "; " : "") + printable(message.substr(begin, end - begin));
        begin = end + 1;
    }
    return line;
}

int fail(const Program& program, std::string_view message) {
    tell(fmt::format("{}: {}\n", program.name, one_line(message)));
    return failed;
}

// A reader that has seen enough is no failure to talk about.
int fail_to_print(const Program& program) {
    return errno == EPIPE ? failed
                          : fail(program, fmt::format("standard output: cannot be written: {}",
                                                      std::strerror(errno)));
}

int misuse(const Program& program, std::string message) {
    std::replace(message.begin(), message.end(), '\n', ' ');
    tell(fmt::format("{}: {} (see --help)\n", program.name, printable(message)));
    return misused;
}

// One line for whatever is wrong with the arguments; help and version are no mistakes.
int explain(const Program& program, const CLI::App& parser, const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
        parser.exit(error);
        return std::cout.flush() ? done : fail_to_print(program);
    }
    return misuse(program, error.what());
}

int run_command(const Program& program, const Command& command, const Interrupt& interrupt) {
    const auto result = command.run();
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
        return fail_to_print(program);
    }
    if (result) {
        return done;
    }
    const std::string& message = result.error().message;
    if (result.error().kind == Error::Kind::usage) {
        return misuse(program, message);
    }
    const bool is_told = message.starts_with("interrupted");
    return fail(program, interrupt.requested() && !is_told ? "interrupted" : message);
}

int parse_and_run(const Program& program, std::span<char*> texts, CLI::App& parser,
                  Interrupt& interrupt) {
    std::vector<Command> commands;
    commands.reserve(program.commands.size());
    for (const auto add : program.commands) {
        commands.push_back(add(parser, interrupt));
    }
    check_texts(texts);
    check_verb(texts, program, commands);
    std::vector<std::string> reversed(texts.rbegin(), texts.rend());
    parser.parse(reversed);
    const auto named = std::find_if(commands.begin(), commands.end(), [](const Command& command) {
        return command.arguments->parsed();
    });
    return named == commands.end() ? done : run_command(program, *named, interrupt);
}

int run(const Program& program, int argc, char** argv) {
    Interrupt interrupt;
    CLI::App parser{program.description, program.name};
    parser.set_version_flag("--version", version_text());
    parser.require_subcommand(1);
    parser.footer(program.footer + "\n" + status_help);
    try {
        const std::span<char*> all(argv, static_cast<std::size_t>(argc));
        return parse_and_run(program, all.subspan(argc > 0 ? 1 : 0), parser, interrupt);
    } catch (const CLI::ParseError& error) {
        return explain(program, parser, error);
    }
}

} // namespace

int run_program(const Program& program, int argc, char** argv) noexcept {
    keep_streams_open();
    try {
        return run(program, argc, argv);
    } catch (const std::bad_alloc&) {
        return fail(program, "there is not enough memory for this");
    } catch (const std::exception& error) {
        return std::ferror(stdout) != 0 ? fail_to_print(program) : fail(program, error.what());
    }
}

} // namespace reljef::cli
