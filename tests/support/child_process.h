#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/test_program.h"

namespace reljef::test {

/// A pipe that other programs do not inherit; its ends are -1 where it could not be made.
struct Pipe {
    Pipe();
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;
    ~Pipe();
    void close_end(std::size_t end);

    std::array<int, 2> ends{-1, -1}; ///< read, write
};

/// This process's environment with changes: "NAME=value".
std::vector<std::string>
environment_with(const std::map<std::string, std::optional<std::string>>& changes);

/// As C functions take them, with a null pointer at the end. They point into the texts.
std::vector<char*> pointers_to(std::vector<std::string>& texts);

/// Reads what a program says until it has closed both, and interrupts it as the options say; kills
/// it, with what it started, where it takes too long.
void read_all(const Pipe& out, const Pipe& err, int process, const ProgramOptions& options,
              ProgramResult& result);

/// As ProgramResult tells it, of what waitpid() does.
int exit_code_of_status(int status);

} // namespace reljef::test
