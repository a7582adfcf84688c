#include "app/choice/calibrate_command.h"

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/cli/console_log.h"
#include "app/cli/options.h"
#include "app/cli/output_files.h"
#include "app/cli/parsed_option.h"
#include "app/cli/program.h"
#include "app/cli/progress_line.h"
#include "engine/core/atomic_file.h"
#include "engine/session/calibration/calibration.h"
#include "engine/session/calibration/measure_costs.h"

namespace reljef::app {
namespace {

struct CalibrateChoice {
    std::optional<session::BackendKind> context;
    glm::ivec2 size{1024, 768};
    int threads = 0;
    std::filesystem::path output;
    bool quiet = false;
};

// What `auto` chooses between: rays on the CPU draw every tile.
Result<std::optional<session::BackendKind>> parse_opengl(const std::string& text) {
    const auto kind = session::backend_from_string(text);
    if (text == "auto") {
        return std::optional<session::BackendKind>();
    }
    if (!kind || *kind == session::BackendKind::cpu) {
        return Error{
            fmt::format("--context: '{}' found, auto, egl or osmesa was expected{}", text,
                        kind ? "; on cpu rays draw every tile, so nothing is chosen" : "")};
    }
    return kind;
}

// In smaller pictures, triangles and rays cost too little to tell them apart; larger ones take
// long.
Result<glm::ivec2> parse_calibrated_size(const std::string& text) {
    constexpr glm::ivec2 smallest(320, 240);
    constexpr int largest_side = 4096;
    auto size = cli::parse_size(text, largest_side);
    if (size && (size->x < smallest.x || size->y < smallest.y)) {
        return Error{fmt::format("--size: {} found, {}x{} or more was expected, in which triangles "
                                 "and rays take some time",
                                 text, smallest.x, smallest.y)};
    }
    return size;
}

Result<session::TerrainScene> natural(const CalibrateChoice& choice, session::Log& log,
                                      const std::stop_token& stop) {
    session::SourceOptions source;
    source.terrain = "natural";
    source.threads = choice.threads;
    session::SceneOptions view;
    view.max_error = 1.0; // with the maps of triangles with a bound
    view.size = choice.size;
    view.pose = scene::Pose::overview;
    return session::open_scene(source, view, log, stop);
}

Result<void> calibrate(const CalibrateChoice& choice, const cli::Interrupt& interrupt) {
    if (choice.output.extension() != ".json") {
        return usage_error(
            fmt::format("-o: '{}' found, a file whose name ends in .json was expected",
                        choice.output.string()));
    }
    const std::array outputs{cli::NamedFile{"-o", choice.output}};
    if (auto writable = cli::check_writable(outputs); !writable) {
        return writable;
    }
    cli::ConsoleLog log(choice.quiet);
    auto scene = natural(choice, log, interrupt.token());
    if (!scene) {
        return scene.error();
    }
    auto device = session::Device::create({.context = choice.context,
                                           .size = choice.size,
                                           .threads = choice.threads,
                                           .selects_always = true});
    if (!device) {
        return device.error();
    }
    cli::ProgressLine line("measuring", choice.quiet);
    const auto frames =
        session::measure_frames(*scene, device->renderer(), interrupt.token(), line.callback());
    if (!frames) {
        return frames.error();
    }
    const session::Calibration made{session::place_of(device->info(), cli::version_text()),
                                    session::costs_from(*frames)};
    const double triangles_ns = made.costs.triangle_ns + made.costs.touched_pixel_ns;
    if (triangles_ns == 0.0 || made.costs.ray_pixel_ns == 0.0) {
        return Error{"calibrate: frames with more triangles or rays took no longer than those with "
                     "fewer, longer ones were expected: try again while no other program runs"};
    }
    return write_text_file(choice.output, to_text(made));
}

} // namespace

cli::Command add_calibrate_command(CLI::App& program, cli::Interrupt& interrupt) {
    auto choice = std::make_shared<CalibrateChoice>();
    auto* arguments = program.add_subcommand(
        "calibrate", "measure what triangles and rays cost here, for the technique auto");
    arguments->add_option("-o", choice->output, "the file of costs, .json")
        ->type_name("FILE")
        ->required();
    cli::add_parsed(*arguments, "--context", choice->context, parse_opengl,
                    "what draws: egl (GPU without a window) or osmesa (CPU); auto: the first that "
                    "works (auto)",
                    "KIND");
    cli::add_parsed(*arguments, "--size", choice->size, parse_calibrated_size,
                    "size of the pictures, 320x240 to 4096x4096 pixels (1024x768)", "WxH");
    cli::add_parsed(*arguments, "--threads", choice->threads,
                    cli::number_in<int>("--threads", 0, 1024),
                    "number of threads; 0: one per processor (0)", "N");
    arguments->add_flag("--quiet", choice->quiet, "no progress and no notes on stderr");
    arguments->footer("The costs hold for this machine, this version and this context. Other "
                      "programs that run\nmeanwhile make them wrong.\n"
                      "Examples:\n  reljef calibrate -o here.json\n"
                      "  reljef render natural --technique auto --calibration here.json -o a.png");
    return {arguments, [choice, &interrupt] { return calibrate(*choice, interrupt); }};
}

} // namespace reljef::app
