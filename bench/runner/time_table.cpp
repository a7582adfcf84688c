#include "bench/runner/time_table.h"

#include <algorithm>
#include <limits>

#include "bench/report/results.h"
#include "engine/core/check.h"

namespace reljef::bench {
namespace {

constexpr double seconds_a_group = 20.0;
constexpr double noisy_seconds_a_group = 60.0;
constexpr int max_rounds = 2000;
constexpr double quick_timing = 10.0; // seconds, all groups together
constexpr int max_quick_rounds = 200;

double mean_or_0(double sum, int count) {
    return count > 0 ? sum / count : 0.0;
}

} // namespace

double group_seconds(const SuiteOptions& options, double elapsed, std::size_t groups_left) {
    check(groups_left > 0, "time for no group");
    if (!options.quick || options.rounds > 0) {
        return std::numeric_limits<double>::infinity();
    }
    const double limit = options.quick_seconds - (options.keep_views ? page_seconds : 0.0);
    return std::max(limit - elapsed, 0.0) / static_cast<double>(groups_left);
}

GroupCost with_another(const GroupCost& cost, std::optional<double> frame) {
    const double checking = mean_or_0(cost.error_seconds, cost.checked);
    return {cost.elapsed + checking, cost.error_seconds + checking, cost.checked + 1,
            cost.round + frame.value_or(mean_or_0(cost.round, cost.frames)), cost.frames + 1};
}

bool fits(const GroupCost& cost, double seconds) {
    return cost.elapsed + static_cast<double>(min_frames) * cost.round <= seconds;
}

MeasureOptions measuring(const SuiteOptions& options, std::size_t groups, double seconds_left) {
    MeasureOptions measure;
    measure.min_rounds = static_cast<int>(min_frames);
    measure.max_noise = max_noise;
    measure.max_rounds = max_rounds;
    measure.seconds = seconds_a_group;
    measure.noisy_seconds = noisy_seconds_a_group;
    if (options.quick) {
        measure.warm_up_rounds = 0; // the error check already drew each
        measure.max_rounds = max_quick_rounds;
        measure.seconds = quick_timing / static_cast<double>(groups);
        measure.noisy_seconds = 2.0 * measure.seconds;
        measure.max_seconds = seconds_left;
    }
    if (options.rounds > 0) {
        measure.min_rounds = options.rounds;
        measure.max_rounds = options.rounds;
        measure.seconds = 0.0;
        measure.max_seconds = std::numeric_limits<double>::infinity();
    }
    return measure;
}

} // namespace reljef::bench
