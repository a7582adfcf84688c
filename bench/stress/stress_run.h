#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "bench/stress/stress_results.h"
#include "engine/session/scene_renderer.h"
#include "engine/terrain/field/heightfield.h"

namespace reljef::bench {

/// The largest of some values and where it was found; not a number is larger than any.
class Worst {
public:
    void add(double value, std::string_view at) {
        if (at_.empty() || std::isnan(value) || value > value_) {
            value_ = std::isnan(value_) ? value_ : value;
            at_ = at;
        }
    }
    [[nodiscard]] double value() const { return value_; }
    [[nodiscard]] const std::string& at() const { return at_; }

private:
    double value_ = 0.0;
    std::string at_;
};

/// What the stresses share: options, the device, and the rows so far.
class StressRun {
public:
    /// `terrains`: those of the options; built-in ones are small.
    StressRun(StressResults& results, const std::vector<terrain::Terrain>& terrains,
              std::stop_token stop)
        : results_(results), terrains_(terrains), stop_(std::move(stop)) {}
    void use(session::Device& device) { device_ = &device; }
    /// `only`: the name of the stress that adds the next rows.
    void begin(std::string_view only) { only_ = only; }

    [[nodiscard]] const StressOptions& options() const { return results_.options; }
    [[nodiscard]] const std::vector<terrain::Terrain>& terrains() const { return terrains_; }
    /// Precondition: use() was called.
    [[nodiscard]] session::SceneRenderer& renderer() { return device_->renderer(); }
    [[nodiscard]] glm::ivec2 size() const { return options().suite.size; }
    [[nodiscard]] ParallelOptions parallel() const {
        return {static_cast<unsigned>(options().suite.threads), stop_, {}};
    }
    [[nodiscard]] bool stopped() const { return stop_.stop_requested(); }
    [[nodiscard]] const std::stop_token& stop() const { return stop_; }
    /// A number of cases: of a quick run or of a full one.
    [[nodiscard]] int cases(int quick, int full) const {
        return options().suite.quick ? quick : full;
    }

    void add(StressRow row) {
        row.only = only_;
        results_.add(std::move(row));
    }

private:
    StressResults& results_;
    session::Device* device_ = nullptr;
    const std::vector<terrain::Terrain>& terrains_;
    std::stop_token stop_;
    std::string only_;
};

/// The techniques to stress: those of the options, or all that draw terrains.
std::vector<scene::Technique> stressed_techniques(const StressOptions& options);

// The stresses of accuracy. Each adds its rows; a stopped one ends early.
Result<void> stress_moved_scenes(StressRun& run);
Result<void> stress_creeping_camera(StressRun& run);
Result<void> stress_depth_order(StressRun& run);
Result<void> stress_grazing_views(StressRun& run);
Result<void> stress_standard_poses(StressRun& run);
Result<void> stress_views_near_the_ground(StressRun& run);
Result<void> stress_hard_cameras(StressRun& run);
Result<void> stress_odd_heights(StressRun& run);
Result<void> stress_odd_files(StressRun& run);
Result<void> stress_scales(StressRun& run);
Result<void> stress_details(StressRun& run);
Result<void> stress_tangent_frames(StressRun& run);
Result<void> stress_error_bound(StressRun& run);
Result<void> stress_streamed_bound(StressRun& run);
Result<void> stress_streamed_repeats(StressRun& run);
Result<void> stress_paths(StressRun& run);
Result<void> stress_thread_counts(StressRun& run);
Result<void> stress_repeats(StressRun& run);
Result<void> stress_contexts(StressRun& run);
Result<void> stress_geodesy(StressRun& run);

} // namespace reljef::bench
