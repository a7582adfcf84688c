#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include <glm/vec2.hpp>

#include "engine/core/result.h"
#include "engine/scene/motion/poses.h"
#include "engine/session/options.h"

namespace CLI {
class App;
}

namespace reljef::cli {

struct TerrainChoice : session::SourceOptions {
    bool quiet = false; ///< no progress and no notes on stderr
};

struct ViewChoice : session::SceneOptions {
    std::optional<session::BackendKind> context; ///< absent: auto
    std::string simd;           ///< instruction set of rays on the CPU; empty: the fastest
    std::optional<int> samples; ///< per pixel; absent: 4 for pictures with triangles, else 1
    std::string path; ///< a built-in path ("orbit", "flyover") or a path file; empty: none
    int frames = 1;
    bool allow_underground = false; ///< keeps cameras that are below the ground
    double frames_per_second = 25.0;
    std::filesystem::path shader_dir;
    std::filesystem::path calibration; ///< a file of 'reljef calibrate'; empty: built-in costs
};

/// A pose by its name; the error names the option --pose.
Result<scene::Pose> parse_pose(std::string_view text);
/// Parses "1024x768". Each side is 1 to `max_side` pixels.
Result<glm::ivec2> parse_size(std::string_view text, int max_side = 16384);

/// The functions below add a group of options to a command. Wrong values throw CLI::ParseError.
void add_terrain_options(CLI::App& command, TerrainChoice& choice);
/// The terrain options that choose heights, without those that draw them.
void add_source_options(CLI::App& command, TerrainChoice& choice);
/// Uses indexes unless `--no-index` is given or the terrain is standard input.
void add_index_option(CLI::App& command, TerrainChoice& choice, session::IndexUse use);
void add_gaps_option(CLI::App& command, TerrainChoice& choice);
void add_view_options(CLI::App& command, ViewChoice& choice);
void add_samples_option(CLI::App& command, ViewChoice& choice);
void add_marks_option(CLI::App& command, ViewChoice& choice);
/// The option or file that places the camera.
std::string camera_source(const ViewChoice& view, const TerrainChoice& terrain);
/// Throws CLI::ParseError if options contradict each other. For the command's callback.
void check_view_options(const ViewChoice& choice);

} // namespace reljef::cli
