#include "engine/truth/separable_filter.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/core/worker_pool.h"

namespace reljef::truth {
namespace {

int radius_of(std::span<const double> kernel) {
    check(kernel.size() % 2 == 1, "a kernel without a middle");
    return static_cast<int>(kernel.size() / 2);
}

// A row with its first and last sample repeated `radius` times beyond it.
std::vector<double> extended(std::span<const double> row, int radius) {
    const auto margin = static_cast<std::size_t>(radius);
    std::vector<double> result(row.size() + 2 * margin, row.front());
    std::copy(row.begin(), row.end(), result.begin() + radius);
    std::fill(result.end() - radius, result.end(), row.back());
    return result;
}

} // namespace

std::vector<double> gaussian(double deviation, int radius) {
    std::vector<double> kernel;
    for (int x = -radius; x <= radius; ++x) {
        kernel.push_back(std::exp(-0.5 * (x / deviation) * (x / deviation)));
    }
    return kernel;
}

void normalize(std::span<double> kernel) {
    const double sum = std::accumulate(kernel.begin(), kernel.end(), 0.0);
    check(sum != 0.0, "a kernel of sum 0");
    for (double& weight : kernel) {
        weight /= sum;
    }
}

void add_scaled(std::span<double> sum, std::span<const double> samples, double weight) {
    check(sum.size() == samples.size(), "rows of different lengths");
    for (std::size_t i = 0; i < sum.size(); ++i) {
        sum[i] += weight * samples[i];
    }
}

Plane filtered_along_cols(const Plane& plane, std::span<const double> kernel, unsigned threads) {
    const int radius = radius_of(kernel);
    const auto width = static_cast<std::size_t>(plane.cols());
    Plane result(plane.cols(), plane.rows());
    const auto filter_row = [&](int row) {
        const std::vector<double> samples = extended(plane.row(row), radius);
        for (std::size_t k = 0; k < kernel.size(); ++k) {
            add_scaled(result.row(row), std::span(samples).subspan(k, width), kernel[k]);
        }
    };
    parallel_for(plane.cols() > 0 ? plane.rows() : 0, filter_row, {threads, {}, {}});
    return result;
}

Plane filtered_along_rows(const Plane& plane, std::span<const double> kernel, unsigned threads) {
    const int radius = radius_of(kernel);
    Plane result(plane.cols(), plane.rows());
    const auto filter_row = [&](int row) {
        for (int k = -radius; k <= radius; ++k) {
            const int source = std::clamp(row + k, 0, plane.rows() - 1);
            add_scaled(result.row(row), plane.row(source),
                       kernel[static_cast<std::size_t>(k + radius)]);
        }
    };
    parallel_for(plane.rows(), filter_row, {threads, {}, {}});
    return result;
}

Plane filtered(const Plane& plane, std::span<const double> along_cols,
               std::span<const double> along_rows, unsigned threads) {
    return filtered_along_rows(filtered_along_cols(plane, along_cols, threads), along_rows,
                               threads);
}

} // namespace reljef::truth
