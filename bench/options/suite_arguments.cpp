#include "bench/options/suite_arguments.h"

#include <filesystem>

#include "app/cli/options.h"
#include "app/cli/parsed_option.h"
#include "engine/io/formats/scene_file.h"

namespace reljef::bench {

void add_suite_options(CLI::App& command, SuiteOptions& options) {
    using Context = std::optional<session::BackendKind>;
    command.add_flag("--quick", options.quick,
                     "finish within a minute: smaller pictures, fewer frames");
    cli::add_parsed(command, "--rounds", options.rounds,
                    cli::number_in<int>("--rounds", 1, 1'000'000),
                    "frames per technique (at least 5, and as many as fit in 20 s per table, or in "
                    "60 s if it is noisy)",
                    "N");
    cli::add_parsed(
        command, "--size", options.size,
        [](const std::string& text) { return cli::parse_size(text); },
        "size of the picture, pixels (1024x768)", "WxH");
    cli::add_parsed(
        command, "--context", options.context,
        cli::word_of<Context>("--context", {{"auto", std::nullopt},
                                            {"glfw", session::BackendKind::glfw},
                                            {"egl", session::BackendKind::egl},
                                            {"osmesa", session::BackendKind::osmesa},
                                            {"cpu", session::BackendKind::cpu}}),
        "what draws: OpenGL with glfw (window), egl (GPU without a window) or osmesa (CPU); auto: "
        "egl or osmesa; cpu: as auto, and tables and pareto measure exact rays without OpenGL "
        "beside it (auto)",
        "KIND");
    cli::add_parsed(command, "--threads", options.threads,
                    cli::number_in<int>("--threads", 0, 1024),
                    "number of threads; 0: one per processor (0)", "N");
    command
        .add_option("--shader-dir", options.shader_dir,
                    "use shader files of this folder instead of the built-in ones")
        ->type_name("FOLDER")
        ->check(CLI::ExistingDirectory);
    command.add_flag("--quiet", options.quiet, "no progress and no notes on stderr");
}

void add_drawing_options(CLI::App& command, SuiteOptions& options) {
    command
        .add_option("--calibration", options.calibration,
                    "file of 'reljef calibrate': what triangles and rays cost on this machine, for "
                    "the technique auto (built-in costs)")
        ->type_name("FILE");
    command
        .add_option("--simd", options.simd,
                    "cpu: instruction set of the rays: avx512, avx2, sse4, neon or scalar (the "
                    "fastest of the machine)")
        ->type_name("TARGET");
}

SuiteOptions with_quick_size(SuiteOptions options, const CLI::App& command, glm::ivec2 size) {
    if (options.quick && command.count("--size") == 0) {
        options.size = size;
    }
    return options;
}

// Without --allow-external: results can be repeated only with files that hold all of their data.
void add_terrains_option(CLI::App& command, std::vector<std::string>& terrains,
                         const std::string& default_text, bool with_gallery) {
    command
        .add_option("--terrain", terrains,
                    fmt::format("natural, urban, a scene file (.toml) or a DEM file{}; may be "
                                "repeated ({})",
                                with_gallery ? "; gallery: its detail textures on a square" : "",
                                default_text))
        ->type_name("TERRAIN")
        ->allow_extra_args(false);
}

void add_techniques_option(CLI::App& command, std::vector<scene::Technique>& techniques,
                           const std::string& default_text) {
    command
        .add_option_function<std::vector<std::string>>(
            "--technique",
            [&techniques](const std::vector<std::string>& texts) {
                for (const std::string& text : texts) {
                    const auto technique = scene::parse_technique(text);
                    if (!technique) {
                        throw CLI::ValidationError(technique.error().message);
                    }
                    techniques.push_back(*technique);
                }
            },
            fmt::format("technique to measure besides texture; may be repeated ({})", default_text))
        ->type_name("ID[:key=value,...]")
        ->allow_extra_args(false);
}

std::vector<cli::NamedFile> terrain_files(std::span<const std::string> terrains) {
    std::vector<cli::NamedFile> files;
    for (const std::string& terrain : terrains) {
        files.push_back({"--terrain", terrain});
        if (std::filesystem::path(terrain).extension() == ".toml") {
            const auto scene = io::read_scene_file(terrain);
            if (scene) { // opening the terrain reports the error
                for (const auto& [what, path] : io::named_files(*scene)) {
                    files.push_back({what, path});
                }
            }
        }
    }
    return files;
}

} // namespace reljef::bench
