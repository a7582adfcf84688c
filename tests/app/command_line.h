#pragma once

#include <string>
#include <vector>

#include "tests/support/temporary_folder.h"
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

/// Writes a scene file into the folder and returns its path: the built-in terrain `name` with a
/// sixtieth of its samples. It is made and drawn in a fraction of the time.
std::string small_terrain(const TemporaryFolder& folder, const std::string& name);

/// Whether a window can be opened.
bool has_display();

} // namespace reljef::test
