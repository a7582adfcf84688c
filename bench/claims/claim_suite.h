#pragma once

#include <cstddef>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "bench/claims/cut_city.h"
#include "bench/report/figure_table.h"
#include "bench/report/results.h"
#include "bench/runner/suite_options.h"

namespace reljef::bench {

struct ClaimOptions {
    SuiteOptions suite;
    int tile = 256;                   ///< cells a side of the repeated tile
    std::vector<int> copies{2, 4, 8}; ///< of it, along each side
    LoneCityOptions lone;
    std::vector<scene::Pose> poses{scene::Pose::overview, scene::Pose::oblique};
};

/// A way to draw a surface.
struct ClaimRow {
    std::string test; ///< "repeat", "city only", "layers" or "warping"
    std::string scene;
    scene::Pose pose = scene::Pose::overview;
    std::string form;  ///< "one terrain", "one tile" …
    std::string label; ///< of the technique
    Timing timing = {};
    std::size_t nodes = 1;              ///< that draw the surface
    std::size_t bytes = 0;              ///< sent to the GPU for the first frame; 0: not counted
    std::optional<double> taps = {};    ///< for each pixel; absent: not counted
    std::optional<RowError> error = {}; ///< absent: no picture was drawn
};

struct ClaimResults {
    ClaimOptions options;
    Environment environment;
    std::vector<ClaimRow> rows;
    RunEnd end;
};

FigureTable figure_table(const ClaimResults& results);

/// Measures what conclusions of the sources claim, frames of one scene and pose interleaved:
/// - repeat: a city of one tile, drawn as one terrain and as nodes that share the tile;
/// - city only: a city in the middle of level ground, drawn by one technique everywhere, as one
///   terrain and in pieces, and by a plain texture on the pieces of one height;
/// - layers: bricks, which one layer shows, by relief and by four layers;
/// - warping: the two phases of forward warping.
/// Errors are those against the exact picture of the whole surface.
ClaimResults run_claims(const ClaimOptions& options, const std::stop_token& stop);

} // namespace reljef::bench
