#include "engine/terrain/light/sky_share.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "engine/core/parallel_for.h"
#include "engine/terrain/light/sky_sweep.h"

namespace reljef::terrain {
namespace {

// Half of the directions; each line is swept both ways. Every sample is on one line of a direction.
constexpr std::array<glm::ivec2, 8> steps{
    {{1, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 1}, {-1, 2}, {-1, 1}, {-2, 1}}};

double angle_of(glm::ivec2 step, glm::dvec2 spacing) {
    return std::atan2(step.y * spacing.y, step.x * spacing.x);
}

// The part of half the circle that a direction stands for.
double weight_of(std::size_t index, glm::dvec2 spacing) {
    const std::size_t count = steps.size();
    const double half = std::numbers::pi;
    const double next = index + 1 < count ? angle_of(steps[index + 1], spacing)
                                          : angle_of(steps[0], spacing) + half;
    const double last = index > 0 ? angle_of(steps[index - 1], spacing)
                                  : angle_of(steps[count - 1], spacing) - half;
    return 0.5 * (next - last) / half;
}

Grid<float> transposed(GridView<const float> grid) {
    constexpr int block = 16; // samples a side: what lies in few pages
    Grid<float> result(grid.rows(), grid.cols());
    parallel_for((grid.rows() + block - 1) / block, [&](int band) {
        const int end_row = std::min((band + 1) * block, grid.rows());
        for (int first = 0; first < grid.cols(); first += block) {
            for (int col = first; col < std::min(first + block, grid.cols()); ++col) {
                for (int row = band * block; row < end_row; ++row) {
                    result(row, col) = grid(col, row);
                }
            }
        }
    });
    return result;
}

// Parts of the lines that are worth a thread.
std::vector<SkyLines> parts_of(const SkySweep& sweep) {
    constexpr int cols_a_part = 4 * max_sky_lines;
    const int last_step = (sweep.heights.rows() - 1) / sweep.step.y;
    const int reach = sweep.step.x * last_step; // of the last samples from the first ones
    const int end = sweep.heights.cols() - std::min(reach, 0);
    std::vector<SkyLines> parts;
    for (int row = 0; row < std::min(sweep.step.y, sweep.heights.rows()); ++row) {
        for (int col = -std::max(reach, 0); col < end; col += cols_a_part) {
            parts.push_back({row, col, std::min(col + cols_a_part, end)});
        }
    }
    return parts;
}

void sweep(const SkySweep& sweep, Grid<float>& share) {
    const std::vector<SkyLines> parts = parts_of(sweep);
    parallel_for(static_cast<int>(parts.size()),
                 [&](int part) { sweep_sky(sweep, parts[static_cast<std::size_t>(part)], share); });
}

// The same line on the transposed grid.
glm::ivec2 transposed_step(glm::ivec2 step) {
    return step.x < 0 ? glm::ivec2(-step.y, -step.x) : glm::ivec2(step.y, step.x);
}

std::uint8_t byte_of(float share) {
    return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(share, 0.0F, 1.0F)));
}

} // namespace

Grid<std::uint8_t> sky_share(GridView<const float> heights, glm::dvec2 spacing,
                             double exaggeration) {
    const auto sweep_all = [&](GridView<const float> ground, bool along_rows, Grid<float>& share) {
        for (std::size_t index = 0; index < steps.size(); ++index) {
            const glm::ivec2 step = steps[index];
            if ((step.y < std::abs(step.x)) == along_rows) {
                const double length = std::hypot(step.x * spacing.x, step.y * spacing.y);
                sweep({ground, along_rows ? transposed_step(step) : step,
                       static_cast<float>(exaggeration / length),
                       static_cast<float>(0.5 * weight_of(index, spacing))},
                      share);
            }
        }
    };
    Grid<float> transposed_share(heights.rows(), heights.cols(), 0.0F);
    // Lines that go from row to row lie side by side in the memory.
    sweep_all(transposed(heights).view(), true, transposed_share);
    Grid<float> share = transposed(std::exchange(transposed_share, {}).view());
    sweep_all(heights, false, share);
    Grid<std::uint8_t> bytes(heights.cols(), heights.rows());
    std::transform(share.samples().begin(), share.samples().end(), bytes.samples().begin(),
                   byte_of);
    return bytes;
}

} // namespace reljef::terrain
