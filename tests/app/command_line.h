#pragma once

#include <string>
#include <vector>

#include "tests/support/test_program.h"

namespace reljef::test {

/// Runs the program `reljef`, as run_forked.
ProgramResult reljef(const std::vector<std::string>& arguments, const ProgramOptions& options = {});

/// What was said on stderr but for the progress of what took over a second on this machine.
std::string without_progress(const std::string& err);

/// Expects that the run failed with `exit_code` and one line on stderr that begins with "reljef: "
/// and holds each of `parts`.
void expect_refusal(const ProgramResult& result, int exit_code,
                    const std::vector<std::string>& parts);

/// Whether a window can be opened.
bool has_display();

} // namespace reljef::test
