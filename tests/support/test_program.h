#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace reljef::test {

/// A signal for a running program.
struct Interruption {
    int signal = 0; ///< 0: none
    /// Asked again and again, with the program's process, until it says so: by what the program has
    /// done, as a busy machine takes its time.
    std::function<bool(int process)> when;
};

struct ProgramOptions {
    /// Added to the test's own environment; a variable without a value is removed from it.
    std::map<std::string, std::optional<std::string>> environment;
    std::filesystem::path folder;             ///< to run in; empty: the test's own
    std::filesystem::path input{"/dev/null"}; ///< its stdin
    std::chrono::seconds timeout{240};        ///< then the program and what it started are killed
    Interruption interruption = {};
};

struct ProgramResult {
    int exit_code = -1; ///< 128 + the signal's number where one ended it; 127: it did not start
    bool timed_out = false;
    std::string out; ///< all of stdout
    std::string err; ///< all of stderr
};

/// Runs a program to its end without a shell.
ProgramResult run_program(const std::filesystem::path& program,
                          const std::vector<std::string>& arguments,
                          const ProgramOptions& options = {});

} // namespace reljef::test
