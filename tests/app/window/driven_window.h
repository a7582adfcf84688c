#pragma once

#include <map>
#include <optional>
#include <string>

#include "tests/support/temporary_folder.h"
#include "tests/support/test_program.h"

namespace reljef::test {

/// What `reljef view` shows.
struct WindowOptions {
    std::string options = "--technique texture"; ///< as on the command line, words of a shell
    std::string size = "320x240";
    std::string terrain = {};      ///< a path; empty: a small natural terrain
    std::string title = "natural"; ///< its name, as the title has it
    std::map<std::string, std::optional<std::string>> environment = {};
};

/// Whether a window can be opened, and xdotool can press its keys.
bool can_drive();

/// Opens a window and runs a script in `folder`. `steps` may use "$viewer" (the process),
/// "$window", `titled TEXT` (waits until the title has it), `until_true COMMAND`, `pressed KEY` and
/// `clicked X Y`. They end the window. Returns the output of both, and the viewer's exit code.
ProgramResult drive(const TemporaryFolder& folder, const std::string& steps,
                    const WindowOptions& shown);
inline ProgramResult drive(const TemporaryFolder& folder, const std::string& steps,
                           const std::string& options = "--technique texture") {
    return drive(folder, steps, WindowOptions{.options = options});
}

} // namespace reljef::test
