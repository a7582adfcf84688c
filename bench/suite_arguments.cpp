#include "bench/suite_arguments.h"

#include <charconv>
#include <filesystem>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/cli/options.h"
#include "engine/io/formats/scene_file.h"

namespace reljef::bench {
namespace {

// The value, or the parser library's error.
template <class T> T checked(Result<T> value) {
    if (!value) {
        throw CLI::ValidationError(value.error().message);
    }
    return std::move(*value);
}

std::optional<platform::ContextKind> parse_context(const std::string& text) {
    const auto kind = platform::context_kind_from_string(text);
    if (!kind && text != "auto") {
        throw CLI::ValidationError(fmt::format(
            "--context: '{}' found, one of auto, glfw, egl, osmesa was expected", text));
    }
    return kind;
}

CLI::Validator whole_number_in(int low, int high) {
    return CLI::Validator(
        [=](const std::string& text) {
            int value = 0;
            const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
            const bool fits = code == std::errc{} && end == text.data() + text.size() &&
                              value >= low && value <= high;
            return fits ? std::string()
                        : fmt::format("'{}' found, a whole number from {} to {} was expected", text,
                                      low, high);
        },
        "");
}

} // namespace

void add_suite_options(CLI::App& command, SuiteOptions& options) {
    command.add_flag("--quick", options.quick,
                     "done in a minute, with fewer frames of smaller pictures");
    command
        .add_option("--rounds", options.rounds,
                    "frames of each technique (as many as fit in 20 s a table, in 60 s where they "
                    "are noisy, at least 5)")
        ->type_name("N")
        ->check(whole_number_in(1, 1'000'000));
    command
        .add_option_function<std::string>(
            "--size",
            [&options](const std::string& text) { options.size = checked(cli::parse_size(text)); },
            "of the picture, pixels (1024x768)")
        ->type_name("WxH");
    command
        .add_option_function<std::string>(
            "--context",
            [&options](const std::string& text) { options.context = parse_context(text); },
            "auto, glfw (window), egl (GPU without a window) or osmesa (CPU)")
        ->type_name("KIND");
    command.add_option("--threads", options.threads, "0: as many as the machine has (0)")
        ->type_name("N")
        ->check(whole_number_in(0, 1024));
    command
        .add_option("--shader-dir", options.shader_dir,
                    "shader files here come before the built-in ones")
        ->type_name("FOLDER")
        ->check(CLI::ExistingDirectory);
    command.add_flag("--quiet", options.quiet, "no progress and no notes on stderr");
}

SuiteOptions with_quick_size(SuiteOptions options, const CLI::App& command, glm::ivec2 size) {
    if (options.quick && command.count("--size") == 0) {
        options.size = size;
    }
    return options;
}

void add_terrains_option(CLI::App& command, std::vector<std::string>& terrains,
                         const std::string& otherwise, bool with_gallery) {
    command
        .add_option("--terrain", terrains,
                    fmt::format("natural, urban, a scene file (.toml) or a DEM file{}; may be "
                                "given again ({})",
                                with_gallery ? "; gallery: its tiles on a square" : "", otherwise))
        ->type_name("TERRAIN")
        ->allow_extra_args(false);
}

void add_techniques_option(CLI::App& command, std::vector<scene::Technique>& techniques,
                           const std::string& otherwise) {
    command
        .add_option_function<std::vector<std::string>>(
            "--technique",
            [&techniques](const std::vector<std::string>& texts) {
                for (const std::string& text : texts) {
                    techniques.push_back(checked(scene::parse_technique(text)));
                }
            },
            fmt::format("beside texture; may be given again ({})", otherwise))
        ->type_name("ID[:key=value,...]")
        ->allow_extra_args(false);
}

void add_pose_option(CLI::App& command, std::optional<scene::Pose>& pose) {
    command
        .add_option_function<std::string>(
            "--pose", [&pose](const std::string& text) { pose = checked(cli::parse_pose(text)); },
            "overview, oblique, low, grazing or map (overview)")
        ->type_name("NAME");
}

std::vector<cli::NamedFile> terrain_files(std::span<const std::string> terrains) {
    std::vector<cli::NamedFile> files;
    for (const std::string& terrain : terrains) {
        files.push_back({"--terrain", terrain});
        if (std::filesystem::path(terrain).extension() == ".toml") {
            const auto scene = io::read_scene_file(terrain);
            if (scene) { // else opening it will tell
                files.push_back({"the terrain's heights", scene->heights});
                for (const std::filesystem::path& image : scene->imagery) {
                    files.push_back({"the terrain's imagery", image});
                }
            }
        }
    }
    return files;
}

} // namespace reljef::bench
