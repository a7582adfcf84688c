#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace reljef::test {

struct ProgramOptions {
    /// Added to the test's own environment; a variable without a value is removed from it.
    std::map<std::string, std::optional<std::string>> environment;
    std::filesystem::path folder;             ///< to run in; empty: the test's own
    std::filesystem::path input{"/dev/null"}; ///< its stdin
    std::chrono::seconds timeout{120};        ///< then the program and what it started are killed
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
