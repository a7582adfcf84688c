#include "tests/app/window/driven_window.h"

#include <chrono>
#include <filesystem>

#include "tests/app/command_line.h"

namespace reljef::test {
namespace {

constexpr const char* functions =
    "until_true() { for _ in $(seq 300); do \"$@\" && return; sleep 0.1; done; echo \"never: $*\"\n"
    "    kill -9 $viewer 2>/dev/null; wait $viewer; echo \"the viewer ended with $?\"; exit 9; }\n"
    "has_title() { xdotool getwindowname $window | grep -qF -- \"$1\"; }\n"
    "titled() { until_true has_title \"$1\"; }\n"
    "pressed() { xdotool key --window $window $1 2>/dev/null; }\n" // which may close the window
    "clicked() { xdotool mousemove --window $window $1 $2 click 1; }\n"
    "ended() { ! kill -0 $viewer 2>/dev/null; }\n"
    "find_window() {\n"
    "    window=$(xdotool search --all --onlyvisible --pid $viewer --name \"^reljef - $name\" "
    "2>/dev/null | head -n 1); [ -n \"$window\" ]; }\n";

} // namespace

bool can_drive() {
    return has_display() && std::filesystem::exists("/usr/bin/xdotool");
}

ProgramResult drive(const TemporaryFolder& folder, const std::string& steps,
                    const WindowOptions& shown) {
    static const TemporaryFolder scenes;
    static const std::string natural = small_terrain(scenes, "natural");
    const std::string& terrain = shown.terrain.empty() ? natural : shown.terrain;
    const std::string script =
        functions + ("name='" + shown.title) +
        "'\nenv --default-signal=INT '" RELJEF_BINARY "' view '" + terrain + "' " + shown.options +
        " --size " + shown.size + " & viewer=$!\nuntil_true find_window\n" + steps +
        // A key that closes its window may stay down: xdotool ends where it cannot release it.
        "\nuntil_true ended\nwait $viewer; status=$?\nxdotool keyup Escape\nexit $status\n";
    ProgramOptions options;
    options.folder = folder.path();
    options.environment = shown.environment;
    options.environment["XDG_DATA_HOME"] = (folder.path() / "data").string();
    options.timeout = std::chrono::seconds(200);
    return run_program("/bin/bash", {"-c", script}, options);
}

} // namespace reljef::test
