#include "engine/core/statistics.h"

#include <algorithm>
#include <cmath>
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

} // namespace

double quantile(std::span<const double> samples, double share) {
    check(share >= 0.0 && share <= 1.0, "a quantile outside [0,1]");
    return quantile_of_sorted(sorted(samples), share);
}

double median(std::span<const double> samples) {
    return quantile(samples, 0.5);
}

Summary summarize(std::span<const double> samples) {
    const std::vector<double> in_order = sorted(samples);
    return {quantile_of_sorted(in_order, 0.5), quantile_of_sorted(in_order, 0.95),
            quantile_of_sorted(in_order, 0.99)};
}

double relative_distance(double a, double b) {
    check(a > 0.0 && b > 0.0, "a distance between figures that are not positive");
    return std::abs(a - b) / std::min(a, b);
}

} // namespace reljef
