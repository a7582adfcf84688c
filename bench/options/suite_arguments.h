#pragma once

#include <span>
#include <string>
#include <vector>

#include "app/cli/output_files.h"
#include "bench/runner/suite_options.h"
#include "engine/scene/technique/technique.h"

namespace CLI {
class App;
}

namespace reljef::bench {

// Options are checked as they are parsed (CLI::ParseError).

/// Adds --quick, --rounds, --size, --context, --threads, --shader-dir and --quiet.
void add_suite_options(CLI::App& command, SuiteOptions& options);

/// Adds --calibration and --simd, for suites that draw with `auto` and by rays on the CPU.
void add_drawing_options(CLI::App& command, SuiteOptions& options);

/// Sets the picture size to `size` if --quick is given and --size is not.
SuiteOptions with_quick_size(SuiteOptions options, const CLI::App& command, glm::ivec2 size);

/// Adds the repeatable option --terrain. `default_text` describes its default.
void add_terrains_option(CLI::App& command, std::vector<std::string>& terrains,
                         const std::string& default_text, bool with_gallery = false);

/// Adds the repeatable option --technique. `default_text` describes its default.
void add_techniques_option(CLI::App& command, std::vector<scene::Technique>& techniques,
                           const std::string& default_text);

/// The files of terrains and those that their scene files name; no output may replace them.
std::vector<cli::NamedFile> terrain_files(std::span<const std::string> terrains);

} // namespace reljef::bench
