#pragma once

#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "bench/baselines/triangle_methods.h"
#include "bench/runner/suite_options.h"
#include "engine/core/result.h"

namespace reljef::bench {

struct MethodsOptions {
    SuiteOptions suite;
    std::vector<std::string> terrains;             ///< of each the middle 2^n+1 × 2^n+1 samples
    std::vector<double> errors{0.003, 0.01, 0.03}; ///< parts of the terrain's height range
};

struct MethodRow {
    std::string terrain;
    int side = 0; ///< samples
    TriangleMethod method = TriangleMethod::bisection;
    double error = 0.0; ///< asked for, metres
    MethodResult result;
};

struct MethodsResults {
    std::vector<MethodRow> rows;
    std::optional<Error> stopped; ///< why the run ended early
    bool failed = false;          ///< so it did by an error, and not as it was asked to
};

/// Triangles and the error they leave, by each way to triangulate, on the CPU alone.
MethodsResults run_methods(const MethodsOptions& options, const std::stop_token& stop);

std::string methods_table(const MethodsResults& results);
std::string methods_json(const MethodsResults& results);

/// Prints the table and writes the JSON, where one is wanted; fails as what stopped the run.
Result<void> report(const MethodsResults& results, const std::filesystem::path& json);

} // namespace reljef::bench
