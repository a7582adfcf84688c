#pragma once

#include <optional>
#include <string>
#include <vector>

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

/// Prints the figures of the errors of a frame.
void print_figures(const CompareChoice& choice, const session::TerrainScene& scene,
                   const std::vector<session::ErrorFigures>& figures);

} // namespace reljef::app
