#pragma once

#include <optional>
#include <string>

#include "engine/session/comparing/compared_picture.h"

namespace CLI {
class App;
}

namespace reljef::app {

struct CompareChoice {
    std::optional<session::CompareRequest> request; ///< absent: nothing is compared
    std::string text;                               ///< as on the command line
    double share = 0.5;                             ///< of the request
};

/// Adds --compare and --wipe. Wrong values throw CLI::ParseError.
void add_compare_option(CLI::App& command, CompareChoice& choice);

/// Compares a frame and prints the figures of its errors; the frame itself without a request.
Result<Image> compared_frame(const CompareChoice& choice, session::TerrainScene& scene,
                             session::FrameMaker& maker, Image left,
                             const ParallelOptions& parallel);

} // namespace reljef::app
