#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include <glm/vec2.hpp>

#include "engine/core/result.h"
#include "engine/platform/context.h"
#include "engine/scene/motion/poses.h"
#include "engine/session/options.h"

namespace CLI {
class App;
}

namespace reljef::cli {

/// Which terrain to open, and what to say about it.
struct TerrainChoice : session::SourceOptions {
    bool quiet = false; ///< no progress and no notes on stderr
};

/// What to draw, and which pictures to make of it.
struct ViewChoice : session::SceneOptions {
    std::optional<platform::ContextKind> context; ///< absent: auto
    glm::ivec2 size{1024, 768};                   ///< pixels
    std::optional<int> samples; ///< of a pixel; absent: 4 where the picture has triangles, else 1
    std::string path; ///< a built-in path ("orbit", "flyover") or a path file; empty: none
    int frames = 1;
    bool allow_underground = false; ///< keeps cameras that are below the ground
    double frames_per_second = 25.0;
    std::filesystem::path shader_dir;
};

/// The largest picture side that may be asked for, pixels.
inline constexpr int largest_picture_side = 16384;

/// A pose by its name; the error names the option --pose.
Result<scene::Pose> parse_pose(std::string_view text);
/// Parses "1024x768". Each side 1 … largest_picture_side.
Result<glm::ivec2> parse_size(std::string_view text);

/// Parses "NAME", or "NAME:width=METRES,scale=S", NAME a built-in tile or a folder.
Result<session::DetailChoice> parse_detail(const std::string& text);

/// Parses exactly `N` finite numbers separated by commas; `option` is named in the error.
template <std::size_t N>
Result<std::array<double, N>> parse_numbers(std::string_view option, std::string_view text,
                                            std::string_view expected);

/// Adds the options of a group to a command; they are checked as they are parsed (CLI::ParseError).
void add_terrain_options(CLI::App& command, TerrainChoice& choice);
/// Of these, what says which heights there are and how they are read, not how they are drawn.
void add_source_options(CLI::App& command, TerrainChoice& choice);
void add_view_options(CLI::App& command, ViewChoice& choice);
/// --samples, for programs that draw pictures to look at.
void add_samples_option(CLI::App& command, ViewChoice& choice);
/// What places the camera: an option, or the terrain or scene file.
std::string camera_source(const ViewChoice& view, const TerrainChoice& terrain);
/// What only all options together show to be wrong (CLI::ParseError). For the command's callback.
void check_view_options(const ViewChoice& choice);

} // namespace reljef::cli
