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

namespace reljef::bench {

struct ErrorBoundOptions {
    SuiteOptions suite;
    std::vector<std::string> terrains; ///< at least one
    int poses = 10'000;                ///< random ones, shared evenly among the terrains
    double error = 1.0;                ///< as --max-error, pixels
    std::vector<double> flight_errors; ///< each flight once with each; empty: `error`
    std::uint32_t seed = 1;            ///< of the random poses
};

/// How views of one kind kept --max-error.
struct ErrorBoundRow {
    std::string scene;
    std::string views;                  ///< "random", "orbit" or "flyover"
    double error = 1.0;                 ///< the bound, pixels
    std::size_t frames = 0;             ///< judged
    std::size_t pixels = 0;             ///< judged that show terrain
    std::size_t violations = 0;         ///< pixels over the bound
    std::size_t holes = 0;              ///< pixels without terrain, where terrain is all around
    double worst_px = 0.0;              ///< infinity if a pixel's error has no bound
    std::optional<scene::Camera> worst; ///< its view
    std::optional<double> triangles;    ///< of flights: mean of the frames
    std::optional<Summary> ms;          ///< of flights
};

struct ErrorBoundResults {
    Environment environment;
    ErrorBoundOptions options;
    std::vector<ErrorBoundRow> rows;
    RunEnd end;

    [[nodiscard]] bool kept() const; ///< without a violation or a hole
};

FigureTable figure_table(const ErrorBoundResults& results);

/// Draws each terrain from random poses and along the paths orbit and flyover, and compares what
/// pixels show with the exact reprojection error (truth::reprojection_error): a sixteenth of the
/// pixels of each random pose, in turns, and all pixels of the flights. Keeps the rows it has when
/// it is stopped or fails.
ErrorBoundResults run_error_bound(const ErrorBoundOptions& options, const std::stop_token& stop);

} // namespace reljef::bench
