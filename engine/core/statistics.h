#pragma once

#include <span>

namespace reljef {

/// The value that a share of the samples lies at or below, between ranks by straight lines (type 7
/// of Hyndman and Fan 1996, "Sample Quantiles in Statistical Packages"). `share` in [0,1].
/// Precondition: there is a sample, and all are finite.
double quantile(std::span<const double> samples, double share);

/// The middle sample, or the mean of the two in the middle. Precondition as quantile().
double median(std::span<const double> samples);

/// What is told of samples, such as frame times or errors, in their unit.
struct Summary {
    double median = 0.0;
    double p95 = 0.0;
    double p99 = 0.0;
};
/// Precondition as quantile().
Summary summarize(std::span<const double> samples);

/// How far apart two positive figures lie, as a share of the smaller one: 0 when they are equal,
/// 0.1 for 10 and 11, whichever comes first.
double relative_distance(double a, double b);

} // namespace reljef
