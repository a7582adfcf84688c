#include "bench/claims/distance_suite.h"

#include <fmt/format.h>

#include "app/cli/progress_line.h"
#include "bench/runner/benchmark_scene.h"
#include "bench/runner/problems.h"

namespace reljef::bench {
namespace {

constexpr double view_down = 35.0; // degrees
constexpr double kilometre = 1000.0;

Result<void> measure_distance(BenchmarkScene& scene, double distance, session::Device& device,
                              DistanceResults& results, const std::stop_token& stop) {
    if (auto good = scene.look_from(distance, view_down); !good) {
        return good;
    }
    for (const scene::Technique& technique : results.options.techniques) {
        const auto measured = scene.measure_error(technique, device.renderer(), stop);
        if (!measured) {
            return measured.error();
        }
        const auto hidden = scene.hidden_percent(device.renderer());
        if (!hidden) {
            return hidden.error();
        }
        results.rows.push_back(
            {scene.name(), distance, scene::to_string(technique), measured->error, *hidden});
    }
    return {};
}

// A distance without a picture costs the others nothing.
void measure_terrain(const std::string& terrain, session::Device& device, DistanceResults& results,
                     Problems& problems, const std::stop_token& stop) {
    auto scene = BenchmarkScene::open({terrain}, results.options.suite, stop);
    if (!scene) {
        return problems.add(scene.error());
    }
    for (const double distance : results.options.distances) {
        if (stop.stop_requested()) {
            return;
        }
        if (auto measured = measure_distance(*scene, distance, device, results, stop); !measured) {
            problems.add(measured.error());
        }
    }
    device.renderer().forget_scene();
}

Result<void> measure_all(DistanceResults& results, const std::stop_token& stop) {
    const DistanceOptions& options = results.options;
    auto device = make_device(options.suite);
    if (!device) {
        return device.error();
    }
    results.environment = environment_of(*device, options.suite.threads);
    cli::ProgressLine line("measuring distances", options.suite.quiet);
    Problems problems;
    for (std::size_t i = 0; i < options.terrains.size() && !stop.stop_requested(); ++i) {
        measure_terrain(options.terrains[i], *device, results, problems, stop);
        line.update(static_cast<double>(i + 1) / static_cast<double>(options.terrains.size()));
    }
    return problems.end();
}

FigureJson json_rms(const std::optional<RowError::Geometric>& error) {
    return error ? FigureJson(error->distribution.rms) : FigureJson();
}

} // namespace

std::string distance_text(double metres) {
    return metres < kilometre ? fmt::format("{} m", metres)
                              : fmt::format("{} km", metres / kilometre);
}

DistanceResults run_distances(const DistanceOptions& options, const std::stop_token& stop) {
    DistanceResults results;
    results.options = options;
    const auto done = measure_all(results, stop);
    results.end = run_end(done, stop, !results.rows.empty());
    results.end.failed = results.end.failed && results.rows.empty();
    return results;
}

FigureTable figure_table(const DistanceResults& results) {
    using namespace columns;
    FigureTable table{
        .suite = "tables-distances",
        .environment = results.environment,
        .shard = {},
        .settings = FigureJson::object({{"size", size_text(results.options.suite.size)}}),
        .summary = {},
        .columns = {group("/scene", "terrain"), name("/at", "distance"),
                    detail(plain("/distance_m", "distance", "m", 0)), name("/label", "technique"),
                    less("/error/reprojection_px/rms", "error", "px", 3),
                    less("/error/wrong_of_terrain_percent", "wrong", "%", 1),
                    detail(less("/error/wrong_percent", "wrong of the picture", "%", 1)),
                    less("/error/hidden_percent", "hidden", "%", 1),
                    less("/error/flip", "FLIP", "", 3)}};
    table.end = results.end;
    for (const DistanceRow& row : results.rows) {
        table.rows.push_back({row.scene, distance_text(row.distance), row.distance, row.label,
                              json_rms(row.error.reprojection_px),
                              json_or_null(row.error.wrong_of_terrain_percent),
                              row.error.wrong_percent, row.hidden_percent, row.error.flip});
    }
    return table;
}

} // namespace reljef::bench
