#include "bench/stress/stress_suite.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "app/cli/console_log.h"
#include "app/cli/progress_line.h"
#include "bench/runner/benchmark_scene.h"
#include "bench/runner/problems.h"
#include "bench/stress/stress_run.h"

namespace reljef::bench {
namespace {

enum class Where {
    own_device, ///< makes its device or none; runs first
    device,     ///< draws with the device of the run
    full_only,  ///< as own_device; not in quick runs
};

struct Stress {
    std::string_view name;
    Result<void> (*run)(StressRun&);
    Where where = Where::device;
};

constexpr std::array stresses{
    Stress{"threads", stress_thread_counts, Where::own_device},
    Stress{"contexts", stress_contexts, Where::own_device},
    Stress{"error-bound", stress_error_bound, Where::own_device},
    Stress{"streamed-bound", stress_streamed_bound, Where::full_only},
    Stress{"streamed-repeat", stress_streamed_repeats, Where::own_device},
    Stress{"tangent-frames", stress_tangent_frames, Where::own_device},
    Stress{"camera-path", stress_paths, Where::own_device},
    Stress{"geodesy", stress_geodesy, Where::own_device},
    Stress{"moved-scene", stress_moved_scenes},
    Stress{"creeping-camera", stress_creeping_camera},
    Stress{"depth-order", stress_depth_order},
    Stress{"standard-pose", stress_standard_poses},
    Stress{"near-ground", stress_views_near_the_ground},
    Stress{"grazing-view", stress_grazing_views},
    Stress{"hard-camera", stress_hard_cameras},
    Stress{"odd-heights", stress_odd_heights},
    Stress{"odd-file", stress_odd_files},
    Stress{"scale", stress_scales},
    Stress{"detail-texture", stress_details},
    Stress{"repeat", stress_repeats},
};

constexpr int quick_built_in_size = 129; // samples a side
constexpr int full_built_in_size = 513;

Result<terrain::Terrain> open_stressed(const std::string& name, const StressOptions& options,
                                       const std::stop_token& stop) {
    session::SourceOptions source;
    source.terrain = name;
    source.threads = options.suite.threads;
    source.placement = terrain::PlacementKind::plane;
    auto description = session::describe(name);
    if (!description) {
        return description.error();
    }
    if (!description->generator.empty()) {
        description->size = options.suite.quick ? quick_built_in_size : full_built_in_size;
        description->walls = building::CityWalls::stepped;
    }
    cli::ConsoleLog log(options.suite.quiet);
    auto opened = session::open_terrain(std::move(*description), source, log, stop);
    if (!opened) {
        return opened.error();
    }
    opened->terrain.name = name;
    return std::move(opened->terrain);
}

class StressSuite {
public:
    StressSuite(StressResults& results, std::stop_token stop)
        : results_(results), stop_(std::move(stop)),
          line_("stressing", results.options.suite.quiet) {}

    Result<void> run() {
        for (const std::string& name : results_.options.terrains) {
            auto terrain = open_stressed(name, results_.options, stop_);
            if (!terrain) {
                problems_.add(terrain.error());
                continue;
            }
            terrains_.push_back(std::move(*terrain));
        }
        if (terrains_.empty() || stop_.stop_requested()) {
            return problems_.end();
        }
        StressRun own(results_, terrains_, stop_);
        run_all(own, [](Where where) { return where != Where::device; });
        auto device = make_device(results_.options.suite);
        if (!device) {
            return device.error();
        }
        results_.environment = environment_of(*device, results_.options.suite.threads);
        own.use(*device);
        run_all(own, [](Where where) { return where == Where::device; });
        return problems_.end();
    }

private:
    template <class Chosen> void run_all(StressRun& run, const Chosen& chosen) {
        std::size_t place = 0;
        for (const Stress& stress : stresses) {
            const bool is_own = is_requested(stress) && results_.options.shard.has(place++);
            if (is_own && chosen(stress.where) && !stop_.stop_requested()) {
                run_one(run, stress);
            }
        }
    }

    [[nodiscard]] bool is_requested(const Stress& stress) const {
        const auto& names = results_.options.stresses;
        if (names.empty()) {
            return stress.where != Where::full_only || !results_.options.suite.quick;
        }
        return std::find(names.begin(), names.end(), stress.name) != names.end();
    }

    void run_one(StressRun& run, const Stress& stress) {
        run.begin(stress.name);
        const auto done = stress.run(run);
        if (!done && !stop_.stop_requested()) {
            run.add({.stress = std::string(stress.name),
                     .figure = "could not be run",
                     .value = std::nan(""),
                     .limit = 0.0,
                     .at = done.error().message});
        }
        const double fraction = ++count_ / static_cast<double>(stresses.size());
        line_.update(fraction);
        if (results_.options.suite.progress) {
            results_.options.suite.progress(fraction);
        }
    }

    StressResults& results_;
    std::stop_token stop_;
    cli::ProgressLine line_;
    std::vector<terrain::Terrain> terrains_;
    Problems problems_; // of terrains
    double count_ = 0.0;
};

} // namespace

std::vector<std::string> stress_names() {
    std::vector<std::string> names;
    std::transform(stresses.begin(), stresses.end(), std::back_inserter(names),
                   [](const Stress& stress) { return std::string(stress.name); });
    return names;
}

std::vector<scene::Technique> stressed_techniques(const StressOptions& options) {
    if (!options.techniques.empty()) {
        return options.techniques;
    }
    std::vector<scene::Technique> techniques;
    for (const scene::TechniqueInfo& info : scene::technique_catalogue()) {
        if (!scene::draws_terrain(info.id)) {
            continue;
        }
        techniques.push_back(scene::make_technique(info.id));
        if (info.id == scene::TechniqueId::polygons) {
            techniques.push_back(scene::Technique{scene::Polygons{.error = 1.0}});
        }
    }
    return techniques;
}

StressResults run_stress(const StressOptions& options, const std::stop_token& stop) {
    StressResults results{.options = options};
    if (results.options.terrains.empty()) {
        results.options.terrains = {"natural", "urban"};
    }
    const auto done = StressSuite(results, stop).run();
    results.end = run_end(done, stop, !results.rows.empty());
    results.end.failed = results.end.failed && results.rows.empty();
    return results;
}

} // namespace reljef::bench
