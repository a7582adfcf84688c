#include "engine/core/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "engine/core/check.h"

namespace reljef {
namespace {

std::vector<double> sorted(std::span<const double> samples) {
    check(!samples.empty(), "statistics of no samples");
    std::vector<double> result(samples.begin(), samples.end());
    std::sort(result.begin(), result.end());
    return result;
}

double quantile_of_sorted(std::span<const double> samples, double share) {
    const double rank = share * static_cast<double>(samples.size() - 1);
    const auto below = static_cast<std::size_t>(rank);
    const std::size_t above = std::min(below + 1, samples.size() - 1);
    return std::lerp(samples[below], samples[above], rank - std::floor(rank));
}

// Reorders the samples.
double median_in_place(std::span<double> samples) {
    const auto middle = samples.begin() + static_cast<std::ptrdiff_t>(samples.size() / 2);
    std::nth_element(samples.begin(), middle, samples.end());
    return samples.size() % 2 == 1 ? *middle
                                   : 0.5 * (*middle + *std::max_element(samples.begin(), middle));
}

// Median of a resample drawn with replacement. The same on every machine: the standard specifies
// the generator but not the distributions.
double median_of_resample(std::span<const double> samples, std::mt19937& random) {
    std::vector<double> drawn(samples.size());
    std::generate(drawn.begin(), drawn.end(),
                  [&] { return samples[(std::uint64_t{random()} * samples.size()) >> 32U]; });
    return median_in_place(drawn);
}

} // namespace

double median(std::span<const double> samples) {
    return quantile_of_sorted(sorted(samples), 0.5);
}

double quantile(std::span<const double> samples, double share) {
    return quantile_of_sorted(sorted(samples), share);
}

Summary summarize(std::span<const double> samples) {
    const std::vector<double> in_order = sorted(samples);
    return {quantile_of_sorted(in_order, 0.5), quantile_of_sorted(in_order, 0.95),
            quantile_of_sorted(in_order, 0.99)};
}

ConfidenceInterval median_interval(std::span<const double> samples,
                                   const BootstrapOptions& options) {
    check(!samples.empty(), "statistics of no samples");
    check(options.resamples >= 1, "a bootstrap without a resample");
    check(options.confidence > 0.0 && options.confidence < 1.0, "a confidence outside (0,1)");
    std::mt19937 random(options.seed);
    std::vector<double> medians(static_cast<std::size_t>(options.resamples));
    std::generate(medians.begin(), medians.end(),
                  [&] { return median_of_resample(samples, random); });
    std::sort(medians.begin(), medians.end());
    const double tail = 0.5 * (1.0 - options.confidence);
    return {quantile_of_sorted(medians, tail), quantile_of_sorted(medians, 1.0 - tail)};
}

double mean_of_largest(std::span<const double> samples, double share) {
    check(share >= 0.0 && share <= 1.0, "a share outside [0,1]");
    const std::vector<double> in_order = sorted(samples);
    constexpr double rounding = 1e-9; // 0.29 of 100 are 29
    const auto part =
        static_cast<std::ptrdiff_t>(share * static_cast<double>(samples.size()) + rounding);
    const std::ptrdiff_t count = std::clamp<std::ptrdiff_t>(part, 1, std::ssize(in_order));
    return std::accumulate(in_order.end() - count, in_order.end(), 0.0) /
           static_cast<double>(count);
}

double relative_distance(double a, double b) {
    check(a > 0.0 && b > 0.0, "a distance between figures that are not positive");
    return std::abs(a - b) / std::min(a, b);
}

} // namespace reljef
