#include "app/cli/program.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <CLI/CLI.hpp>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "app/cli/message.h"
#include "app/cli/parser.h"
#include "app/cli/usage_error.h"

namespace reljef::cli {
namespace {

// Exit status.
constexpr int done = 0;
constexpr int failed = 1;
constexpr int misused = 2;

// If a standard stream is closed, the next opened file would get its descriptor and its output.
// This opens a replacement that fails on use, so that lost output is an error.
void keep_streams_open() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (::fcntl(stream, F_GETFD) == -1) {
            static_cast<void>(::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY));
        }
    }
}

// Joins lines, for example of a shader compiler.
std::string one_line(std::string_view message) {
    std::string line;
    for (std::size_t begin = 0; begin < message.size();) {
        const std::size_t end = std::min(message.find('\n', begin), message.size());
        line += (begin > 0 ? "; " : "") + printable(message.substr(begin, end - begin));
        begin = end + 1;
    }
    return line;
}

int fail(const Program& program, const Error& error) {
    write_error(program.name, error);
    return failed;
}

// What fails may be long ago, and errno that of something else: a last byte finds out.
int report_lost_output(const Program& program) {
    const int reason = ::write(STDOUT_FILENO, "\n", 1) < 0 ? errno : 0;
    if (reason == EPIPE) { // the reader has finished
        return failed;
    }
    return fail(program, {reason == 0 ? std::string("standard output: a part could not be written")
                                      : fmt::format("standard output: cannot be written: {}",
                                                    std::strerror(reason))});
}

int usage_error(const Program& program, std::string message) {
    write_error(program.name, reljef::usage_error(std::move(message)));
    return misused;
}

int explain(const Program& program, const CLI::App& parser, const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
        parser.exit(error);
        return std::cout.flush() ? done : report_lost_output(program);
    }
    return usage_error(program, usage_text(error));
}

int run_command(const Program& program, const Command& command, const Interrupt& interrupt) {
    const auto result = command.run();
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
        return report_lost_output(program);
    }
    if (result) {
        return done;
    }
    const Error& error = result.error();
    const bool is_usage = error.kind == Error::Kind::usage;
    if (command.has_written_error && command.has_written_error()) {
        return is_usage ? misused : failed;
    }
    if (is_usage) {
        return usage_error(program, error.message);
    }
    const bool is_stopped = interrupt.requested() && !error.message.starts_with("interrupted");
    return fail(program, is_stopped ? Error{"interrupted"} : error);
}

int run(const Program& program, int argc, char** argv) {
    Interrupt interrupt;
    Parser parser(program, interrupt);
    try {
        const std::span<char*> all(argv, static_cast<std::size_t>(argc));
        return run_command(program, parser.parse(all.subspan(argc > 0 ? 1 : 0)), interrupt);
    } catch (const CLI::ParseError& error) {
        return explain(program, parser.arguments(), error);
    }
}

int run_made(const Program& program, int argc, char** argv) {
    try {
        return run(program, argc, argv);
    } catch (const std::bad_alloc&) {
        return fail(program, {"there is not enough memory for this"});
    } catch (const std::exception& error) {
        return std::ferror(stdout) != 0 ? report_lost_output(program)
                                        : fail(program, {error.what()});
    }
}

} // namespace

std::string version_text() {
    return "reljef " RELJEF_VERSION;
}

void write_error(std::string_view program, const Error& error) {
    if (error.kind == Error::Kind::failure) {
        write_stderr(fmt::format("{}: {}\n", program, one_line(error.message)));
        return;
    }
    std::string line = error.message;
    std::replace(line.begin(), line.end(), '\n', ' ');
    write_stderr(fmt::format("{}: {} (see --help)\n", program, printable(line)));
}

int run_program(Program (*make)(), int argc, char** argv) noexcept {
    keep_streams_open();
    try {
        return run_made(make(), argc, argv);
    } catch (const std::exception&) { // there was no memory for the program, or for the message
        write_stderr(::program_invocation_short_name);
        write_stderr(": there is not enough memory for this\n");
        return failed;
    }
}

} // namespace reljef::cli
