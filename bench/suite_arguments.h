#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/cli/output_files.h"
#include "bench/runner/suite_options.h"
#include "engine/core/result.h"
#include "engine/scene/motion/poses.h"
#include "engine/scene/technique/technique.h"

namespace CLI {
class App;
}

namespace reljef::bench {

/// Adds --quick, --rounds, --size, --context, --threads and --quiet; they are checked as they are
/// parsed (CLI::ParseError).
void add_suite_options(CLI::App& command, SuiteOptions& options);

/// The options with pictures of `size` where --quick is given and --size is not.
SuiteOptions with_quick_size(SuiteOptions options, const CLI::App& command, glm::ivec2 size);

/// Adds --terrain, which may be given again; `otherwise` says what is measured without it,
/// `with_gallery` that the gallery's tiles can be.
void add_terrains_option(CLI::App& command, std::vector<std::string>& terrains,
                         const std::string& otherwise, bool with_gallery = false);

/// Adds --technique, which may be given again; `otherwise` says what is measured without it.
void add_techniques_option(CLI::App& command, std::vector<scene::Technique>& techniques,
                           const std::string& otherwise);

/// Adds --pose.
void add_pose_option(CLI::App& command, std::optional<scene::Pose>& pose);

/// The terrains as files that no output may replace, and those that their scene files name.
std::vector<cli::NamedFile> terrain_files(std::span<const std::string> terrains);

} // namespace reljef::bench
