#include "engine/truth/separable_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "engine/core/parallel_for.h"

namespace reljef::truth {
namespace {

int radius_of(std::span<const double> kernel) {
    check(kernel.size() % 2 == 1, "a kernel without a middle");
    return static_cast<int>(kernel.size() / 2);
}

using Row = std::span<const double>;

// Repeats the first and the last sample `radius` times.
std::vector<double> extended(Row row, int radius) {
    const auto margin = static_cast<std::size_t>(radius);
    std::vector<double> result(row.size() + 2 * margin, row.front());
    std::copy(row.begin(), row.end(), result.begin() + radius);
    std::fill(result.end() - radius, result.end(), row.back());
    return result;
}

// `count` samples from `begin` on. A fixed count keeps the sums in registers.
template <std::size_t count>
void weighted_block(std::span<double> sum, std::span<const Row> rows,
                    std::span<const double> weights, std::size_t begin) {
    std::array<double, count> block{};
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const double* const samples = rows[k].data() + begin;
        for (std::size_t i = 0; i < count; ++i) {
            block[i] += weights[k] * samples[i];
        }
    }
    std::copy(block.begin(), block.end(), sum.begin() + static_cast<std::ptrdiff_t>(begin));
}

// sum[i] = Σ weights[k]·rows[k][i].
void weighted_sum(std::span<double> sum, std::span<const Row> rows,
                  std::span<const double> weights) {
    constexpr std::size_t block = 8;
    std::size_t i = 0;
    for (; i + block <= sum.size(); i += block) {
        weighted_block<block>(sum, rows, weights, i);
    }
    for (; i < sum.size(); ++i) {
        weighted_block<1>(sum, rows, weights, i);
    }
}

// Each row by itself.
Plane filtered_along_cols(const Plane& plane, std::span<const double> kernel, unsigned threads) {
    const int radius = radius_of(kernel);
    const auto width = static_cast<std::size_t>(plane.cols());
    Plane result(plane.cols(), plane.rows());
    const auto filter_row = [&](int row) {
        const std::vector<double> samples = extended(plane.row(row), radius);
        std::vector<Row> shifted;
        for (std::size_t k = 0; k < kernel.size(); ++k) {
            shifted.push_back(Row(samples).subspan(k, width));
        }
        weighted_sum(result.row(row), shifted, kernel);
    };
    parallel_for(plane.cols() > 0 ? plane.rows() : 0, filter_row, {threads, {}, {}});
    return result;
}

// Each column by itself.
Plane filtered_along_rows(const Plane& plane, std::span<const double> kernel, unsigned threads) {
    const int radius = radius_of(kernel);
    Plane result(plane.cols(), plane.rows());
    const auto filter_row = [&](int row) {
        std::vector<Row> around;
        for (int k = -radius; k <= radius; ++k) {
            around.push_back(plane.row(std::clamp(row + k, 0, plane.rows() - 1)));
        }
        weighted_sum(result.row(row), around, kernel);
    };
    parallel_for(plane.rows(), filter_row, {threads, {}, {}});
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

Plane filtered(const Plane& plane, std::span<const double> along_cols,
               std::span<const double> along_rows, unsigned threads) {
    return filtered_along_rows(filtered_along_cols(plane, along_cols, threads), along_rows,
                               threads);
}

} // namespace reljef::truth
