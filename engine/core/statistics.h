#pragma once

#include <cstdint>
#include <span>

namespace reljef {

// Preconditions of all functions: at least one sample, all finite.

double median(std::span<const double> samples);

/// The quantile of a share in [0,1], interpolated linearly between ranks (type 7 of Hyndman and Fan
/// 1996, "Sample Quantiles in Statistical Packages").
double quantile(std::span<const double> samples, double share);

/// The same of several shares.
struct Summary {
    double median = 0.0;
    double p95 = 0.0;
    double p99 = 0.0;
};
Summary summarize(std::span<const double> samples);

struct ConfidenceInterval {
    double low = 0.0;
    double high = 0.0;
};

struct BootstrapOptions {
    int resamples = 2000;     ///< >= 1
    double confidence = 0.95; ///< (0,1)
    std::uint32_t seed = 1;
};

/// Bootstrap confidence interval of the median by the percentile method (Efron and Tibshirani 1993,
/// "An Introduction to the Bootstrap", ch. 13). Deterministic. Too narrow for under 5 samples.
ConfidenceInterval median_interval(std::span<const double> samples,
                                   const BootstrapOptions& options = {});

/// Mean of the largest `share` (in [0,1]) of the samples: rounded down, at least one sample.
double mean_of_largest(std::span<const double> samples, double share);

/// |a − b| as a share of the smaller one; both must be positive.
double relative_distance(double a, double b);

} // namespace reljef
