#include "bench/suites/scaling_terrain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "app/cli/progress_line.h"
#include "engine/io/formats/raster_writer.h"
#include "engine/material/noise.h"

namespace reljef::bench {
namespace {

namespace fs = std::filesystem;

constexpr double ground_side = 40'000.0; // metres
constexpr glm::dvec2 ground_corner{380'000.0, 5'120'000.0};
constexpr double bytes_a_sample = 4.0 * 17.0 / 16.0; // with overviews

// The ground is a sum of waves in random directions. Shorter waves are lower.
struct Wave {
    glm::dvec2 number{0.0}; // radians along the ground's sides
    double phase = 0.0;     // radians
    double height = 0.0;    // metres
};
constexpr std::size_t wave_count = 24;
constexpr double mean_height = 1500.0;
constexpr double first_height = 700.0;
constexpr double first_number = 9.0;  // radians along a side
constexpr double number_ratio = 1.32; // of successive waves
constexpr double height_ratio = 1.4;

const std::array<Wave, wave_count>& waves() {
    static const auto made = [] {
        std::array<Wave, wave_count> made_waves;
        double number = first_number;
        double height = first_height;
        for (std::size_t i = 0; i < wave_count; ++i) {
            const auto random_angle = [&](std::uint32_t seed) {
                return 2.0 * std::numbers::pi *
                       material::unit_hash(seed, static_cast<std::int32_t>(i), 0);
            };
            const double direction = random_angle(1);
            made_waves[i] = {number * glm::dvec2(std::cos(direction), std::sin(direction)),
                             random_angle(2), height};
            number *= number_ratio;
            height /= height_ratio;
        }
        return made_waves;
    }();
    return made;
}

double place_of_sample(int sample, int side) {
    return (sample + 0.5) / side;
}

// Computes rows of samples: sin(x + y) = sin x cos y + cos x sin y, x depends on the column only.
class GroundRows {
public:
    explicit GroundRows(int side) : side_(side) {
        for (std::size_t i = 0; i < wave_count; ++i) {
            const Wave& wave = waves()[i];
            for (int col = 0; col < side; ++col) {
                const double x = wave.number.x * place_of_sample(col, side) + wave.phase;
                sines_[i].push_back(static_cast<float>(wave.height * std::sin(x)));
                cosines_[i].push_back(static_cast<float>(wave.height * std::cos(x)));
            }
        }
    }

    void fill(int row, std::span<float> heights) const {
        std::fill(heights.begin(), heights.end(), static_cast<float>(mean_height));
        for (std::size_t i = 0; i < wave_count; ++i) {
            const double y = waves()[i].number.y * place_of_sample(row, side_);
            const auto cosine = static_cast<float>(std::cos(y));
            const auto sine = static_cast<float>(std::sin(y));
            for (std::size_t col = 0; col < heights.size(); ++col) {
                heights[col] += sines_[i][col] * cosine + cosines_[i][col] * sine;
            }
        }
    }

private:
    int side_;
    std::array<std::vector<float>, wave_count> sines_; // by wave and column, metres
    std::array<std::vector<float>, wave_count> cosines_;
};

} // namespace

double scaling_height(glm::ivec2 sample, int side) {
    const glm::dvec2 place(place_of_sample(sample.x, side), place_of_sample(sample.y, side));
    double height = mean_height;
    for (const Wave& wave : waves()) {
        height += wave.height * std::sin(glm::dot(wave.number, place) + wave.phase);
    }
    return height;
}

Result<void> write_scaling_terrain(const fs::path& path, int side, const SuiteOptions& suite,
                                   const std::stop_token& stop) {
    cli::ProgressLine line(fmt::format("writing {0} x {0} samples", side), suite.quiet);
    const auto threads = static_cast<unsigned>(suite.threads);
    const GroundRows rows(side);
    const auto fill = [&](int first_row, GridView<float> heights) {
        parallel_for(heights.rows(), [&](int row) { rows.fill(first_row + row, heights.row(row)); },
                     {threads, stop, {}});
    };
    const double spacing = ground_side / side;
    const io::HeightRaster raster{side, side, spacing, ground_corner + 0.5 * spacing};
    return io::write_heights(path, raster, fill, {threads, stop, line.callback()});
}

Result<ScratchFolder> make_scaling_folder(const fs::path& parent, int max_side) {
    std::error_code code;
    const fs::path folder = parent.empty() ? fs::temp_directory_path(code) : parent;
    const double needed = bytes_a_sample * max_side * max_side;
    const auto available = static_cast<double>(fs::space(folder, code).available);
    if (!code && available < needed) {
        return Error{fmt::format("{}: {:.1f} GB free, {:.1f} GB were expected for a raster",
                                 folder.string(), 1e-9 * available, 1e-9 * needed)};
    }
    return ScratchFolder::create(parent);
}

} // namespace reljef::bench
