#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "bench/report/figure_table.h"
#include "bench/runner/suite_options.h"
#include "engine/scene/graph/camera.h"
#include "engine/scene/graph/terrain_node.h"

namespace reljef::bench {

struct ErrorBoundOptions {
    SuiteOptions suite;
    std::vector<std::string> terrains;      ///< at least one
    int built_in_size = 0;                  ///< samples a side of natural and urban; 0: theirs
    int poses = 10'000;                     ///< see random_view(), shared evenly among the terrains
    int near_poses = 0;                     ///< likewise, see view_near_the_ground()
    double error = 1.0;                     ///< as --max-error, pixels
    bool automatic = false;                 ///< the technique auto instead of polygons
    std::vector<double> flight_errors{1.0}; ///< bounds of the flights, pixels
    std::uint32_t seed = 1;                 ///< of the random poses
    std::int64_t skip = 0;                  ///< random poses left out at the beginning
};

/// "plane" or "ellipsoid".
const char* placement_name(terrain::PlacementKind placement);

/// Check of --max-error in the views of one kind.
struct ErrorBoundRow {
    std::string scene;
    std::string views; ///< "random", "near ground", "orbit" or "flyover"
    terrain::PlacementKind placement = terrain::PlacementKind::plane;
    double error = 1.0;                 ///< the bound, pixels
    double stated_px = 0.0;             ///< the largest error that a frame stated
    std::size_t frames = 0;             ///< checked
    std::size_t pixels = 0;             ///< checked pixels that show terrain
    std::size_t violations = 0;         ///< pixels farther off than their frame states
    std::size_t holes = 0;              ///< pixels without terrain, surrounded by terrain
    double worst_px = 0.0;              ///< infinite if a pixel is unbounded
    std::optional<scene::Camera> worst; ///< its view
    std::optional<double> triangles;    ///< of flights: mean per frame
    std::optional<Summary> ms;          ///< of flights
};

struct ErrorBoundResults {
    Environment environment = {};
    ErrorBoundOptions options = {};
    std::vector<ErrorBoundRow> rows = {};
    RunEnd end = {};

    [[nodiscard]] bool within_bound() const; ///< no violation, no hole
};

FigureTable figure_table(const ErrorBoundResults& results);

/// Draws each terrain from random poses, half of them on the ellipsoid if it has a place there, and
/// on a plane along the paths orbit and flyover. Computes the exact reprojection error of a
/// sixteenth of the pixels of each random pose, alternating, and of all pixels of the flights.
/// Keeps its rows when it is stopped or fails. A terrain that cannot be judged costs the others
/// nothing; the run fails at its end.
ErrorBoundResults run_error_bound(const ErrorBoundOptions& options, const std::stop_token& stop);

} // namespace reljef::bench
