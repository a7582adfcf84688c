#pragma once

#include <cstdint>
#include <span>

namespace reljef {

/// The value that a share of the samples lies at or below, between ranks by straight lines (type 7
/// of Hyndman and Fan 1996, "Sample Quantiles in Statistical Packages"). `share` in [0,1].
/// Precondition: there is a sample, and all are finite.
double quantile(std::span<const double> samples, double share);

/// The middle sample, or the mean of the two in the middle. Precondition as quantile().
double median(std::span<const double> samples);

/// Summary of samples, such as frame times or errors, in their unit.
struct Summary {
    double median = 0.0;
    double p95 = 0.0;
    double p99 = 0.0;
};
/// Precondition as quantile().
Summary summarize(std::span<const double> samples);

/// Where a figure of the whole lies, as far as its samples tell.
struct ConfidenceInterval {
    double low = 0.0;
    double high = 0.0;
};

struct BootstrapOptions {
    int resamples = 2000;     ///< >= 1
    double confidence = 0.95; ///< (0,1)
    std::uint32_t seed = 1;
};

/// The interval that holds the median of whatever the samples were drawn from: the quantiles of
/// the medians of resamples drawn with replacement (percentile method; Efron and Tibshirani 1993,
/// "An Introduction to the Bootstrap", ch. 13). The same samples and options give the same bits.
/// Under 5 samples it is narrower than it claims: the resamples hold few different medians. One
/// sample gives an interval of no width. Precondition as quantile().
ConfidenceInterval median_interval(std::span<const double> samples,
                                   const BootstrapOptions& options = {});

/// The mean of the largest samples: the `share` of them, rounded down, but one at least. `share` in
/// [0,1]. Precondition as quantile().
double mean_of_largest(std::span<const double> samples, double share);

/// How far apart two positive figures lie, as a share of the smaller one: 0 when they are equal,
/// 0.1 for 10 and 11, whichever comes first.
double relative_distance(double a, double b);

} // namespace reljef
