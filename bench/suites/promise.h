#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "bench/report/environment.h"
#include "bench/runner/suite_options.h"
#include "engine/core/statistics.h"
#include "engine/scene/graph/camera.h"

namespace reljef::bench {

struct PromiseOptions {
    SuiteOptions suite;
    std::vector<std::string> terrains; ///< at least one
    int poses = 10'000;                ///< random ones, shared evenly among the terrains
    double error = 1.0;                ///< as --max-error asks for, pixels
    std::vector<double> flight_errors; ///< of the flights, one after the other; none: `error`
    std::uint32_t seed = 1;            ///< of the random poses
};

/// How views of one kind kept what --max-error promises.
struct PromiseRow {
    std::string scene;
    std::string views;                  ///< "random", "orbit" or "flyover"
    double error = 1.0;                 ///< that was asked for, pixels
    std::size_t frames = 0;             ///< judged
    std::size_t pixels = 0;             ///< judged that show terrain
    std::size_t violations = 0;         ///< pixels that show a place farther off than asked for
    std::size_t holes = 0;              ///< pixels that show none, where a terrain is all around
    double worst_px = 0.0;              ///< of all of them; infinity where one has no bound
    std::optional<scene::Camera> worst; ///< where that was
    /// Of flights, whose tiles are cut and uploaded as they go: means over their frames, and
    /// milliseconds.
    std::optional<double> triangles;
    std::optional<Summary> ms;
};

struct PromiseResults {
    Environment environment;
    PromiseOptions options;
    std::vector<PromiseRow> rows;
    std::optional<Error> stopped; ///< why the run ended early
    bool failed = false;          ///< so it did by an error, and not as it was asked to

    [[nodiscard]] bool kept() const; ///< without a violation or a hole
};

/// Draws each terrain from random poses, and along the paths orbit and flyover, and holds what
/// pixels show against the definition of the reprojection error (truth::reprojection_error): a
/// sixteenth of the pixels of each random pose, other ones each time, and all of the flights', once
/// for each of their errors. A
/// run that is stopped or fails on the way keeps what it has, and says why in
/// PromiseResults::stopped.
PromiseResults run_promise(const PromiseOptions& options, const std::stop_token& stop);

} // namespace reljef::bench
