#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "app/cli/options.h"
#include "app/cli/output_files.h"
#include "app/comparing/compare_option.h"
#include "engine/core/parallel_for.h"
#include "engine/core/result.h"
#include "engine/session/picture/picture_parts.h"

namespace reljef::app {

/// What `reljef render` draws, from where, and into which files.
struct RenderChoice {
    cli::TerrainChoice terrain;
    cli::ViewChoice view;
    std::filesystem::path output;
    std::filesystem::path hits;
    std::filesystem::path contact_sheet;
    bool stats = false;
    bool shows_choice = false;
    bool truth = false;
    int rays = 1;
    Shard shard;
    bool resume = false;
    CompareChoice compare;
};

/// Whether it is one picture of many pixels, drawn in parts.
bool is_large(const RenderChoice& choice);

session::PictureParts parts_of(const RenderChoice& choice);

/// Throws CLI::ParseError for wrong or contradicting outputs.
void expect_outputs(const RenderChoice& choice);

/// The files that will be written. Numbered pictures are included if they exist or have an input's
/// name.
std::vector<cli::NamedFile> outputs_of(const RenderChoice& choice,
                                       std::span<const cli::NamedFile> inputs);

/// Checks before long work that the outputs can be written.
Result<void> check_targets(const RenderChoice& choice);

} // namespace reljef::app
