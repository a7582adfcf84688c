#include "terrains/natural/natural_land.h"

#include <cmath>
#include <utility>

#include <glm/vec3.hpp>

#include "engine/core/parallel_for.h"
#include "engine/material/noise.h"

namespace reljef::terrains::natural {
namespace {

constexpr int coarsest = 3; // levels of halved resolution
constexpr float highest = 3000.0F;
constexpr float max_uplift = 60.0F; // metres a step
constexpr int steps_of_level[coarsest + 1] = {1, 2, 6, 30};

/// One level of resolution.
struct Level {
    Grid<float> heights;
    Grid<float> uplift;      // share of max_uplift, (0,1]
    Grid<float> erodibility; // relative, about [0.6,1.6]
    Grid<float> talus;       // steepest stable slope
};

int cells_at(int size, int level) {
    return ((size - 1) >> level) + 2;
}

/// The quadratic B-spline of a grid's samples.
float spline(const Grid<float>& grid, float x, float y) {
    const float col = std::floor(x + 0.5F);
    const float row = std::floor(y + 0.5F);
    const auto weights = [](float t) {
        return glm::vec3{0.5F * (0.5F - t) * (0.5F - t), 0.75F - t * t,
                         0.5F * (0.5F + t) * (0.5F + t)};
    };
    const glm::vec3 wx = weights(x - col);
    const glm::vec3 wy = weights(y - row);
    float sum = 0.0F;
    for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i) {
            sum += wx[i] * wy[j] *
                   grid.clamped(static_cast<int>(col) + i - 1, static_cast<int>(row) + j - 1);
        }
    }
    return sum;
}

/// Linear interpolation at the sample (col, row) of a grid with twice the resolution.
float between(const Grid<float>& coarse, int col, int row) {
    const int x = col / 2;
    const int y = row / 2;
    const int right = x + (col & 1);
    const int below = y + (row & 1);
    return 0.25F * (coarse.clamped(x, y) + coarse.clamped(right, y) + coarse.clamped(x, below) +
                    coarse.clamped(right, below));
}

/// A grid of twice the resolution, linear between the coarse samples.
Grid<float> refined(const Grid<float>& coarse, int size, unsigned threads) {
    Grid<float> fine(size, size);
    for_each_cell(size, size, {threads, {}, {}},
                  [&](int col, int row) { fine(col, row) = between(coarse, col, row); });
    return fine;
}

/// A smooth grid of twice the resolution. Noise moves the samples, so that valleys lose the grid's
/// straight directions.
Grid<float> warped(const Grid<float>& coarse, int size, const LandOptions& options) {
    const ParallelOptions parallel{options.threads, {}, {}};
    Grid<float> east(coarse.cols(), coarse.rows());
    Grid<float> south(coarse.cols(), coarse.rows());
    for_each_cell(coarse.cols(), coarse.rows(), parallel, [&](int col, int row) {
        const glm::vec2 place(col, row);
        east(col, row) = 1.1F * material::gradient_noise(options.seed + 51, place / 5.3F) +
                         2.2F * material::gradient_noise(options.seed + 52, place / 13.0F);
        south(col, row) = 1.1F * material::gradient_noise(options.seed + 53, place / 5.3F) +
                          2.2F * material::gradient_noise(options.seed + 54, place / 13.0F);
    });
    Grid<float> fine(size, size);
    for_each_cell(size, size, parallel, [&](int col, int row) {
        const glm::vec2 place = 0.5F * glm::vec2(col, row);
        fine(col, row) =
            spline(coarse, place.x + between(east, col, row), place.y + between(south, col, row));
    });
    return fine;
}

Level first_level(const LandOptions& options) {
    const int size = cells_at(options.size, coarsest);
    const float kilometres = design_spacing * static_cast<float>(1 << coarsest) * 0.001F;
    Level level{Grid<float>(size, size), Grid<float>(size, size), Grid<float>(size, size),
                Grid<float>(size, size, 0.8F)};
    for_each_cell(size, size, {options.threads, {}, {}}, [&](int col, int row) {
        const glm::vec2 place = kilometres * glm::vec2(col, row);
        const float range = material::fractal_noise(options.seed, place / 13.0F, {.octaves = 3});
        const float rock = material::fractal_noise(options.seed + 11, place / 3.5F, {.octaves = 3});
        level.uplift(col, row) = 0.26F + 0.74F * smoothstep(-0.35F, 0.35F, range);
        level.erodibility(col, row) =
            rock > 0.0F ? 1.0F + 1.2F * rock : 1.0F / (1.0F - 1.2F * rock);
        level.heights(col, row) = 120.0F * material::unit_hash(options.seed + 17, col, row) +
                                  300.0F * level.uplift(col, row);
    });
    return level;
}

/// The outlets: the eighth of the border cells with the slowest uplift.
Grid<std::uint8_t> low_border(const Grid<float>& uplift) {
    const int last = uplift.cols() - 1;
    std::vector<float> around;
    for (int i = 0; i <= last; ++i) {
        around.insert(around.end(), {uplift(i, 0), uplift(i, last), uplift(0, i), uplift(last, i)});
    }
    const auto eighth = around.begin() + static_cast<std::ptrdiff_t>(around.size() / 8);
    std::nth_element(around.begin(), eighth, around.end());
    Grid<std::uint8_t> outlets(last + 1, last + 1);
    for (int i = 0; i <= last; ++i) {
        for (const glm::ivec2 cell :
             {glm::ivec2(i, 0), glm::ivec2(i, last), glm::ivec2(0, i), glm::ivec2(last, i)}) {
            outlets(cell.x, cell.y) = uplift(cell.x, cell.y) <= *eighth ? 1 : 0;
        }
    }
    return outlets;
}

/// The outlets of the next finer level.
Grid<std::uint8_t> refined(const Grid<std::uint8_t>& coarse, int size) {
    Grid<std::uint8_t> fine(size, size);
    for (int i = 0; i < size; ++i) {
        fine(i, 0) = coarse(i / 2, 0);
        fine(0, i) = coarse(0, i / 2);
        fine(i, size - 1) = coarse(i / 2, coarse.rows() - 1);
        fine(size - 1, i) = coarse(coarse.cols() - 1, i / 2);
    }
    return fine;
}

Grid<float> talus_of(const Grid<float>& heights, float kilometres, const LandOptions& options) {
    Grid<float> talus(heights.cols(), heights.rows());
    const ParallelOptions parallel{options.threads, {}, {}};
    for_each_cell(heights.cols(), heights.rows(), parallel, [&](int col, int row) {
        const glm::vec2 place = kilometres * glm::vec2(col, row);
        const float rock = material::fractal_noise(options.seed + 23, place / 0.7F, {.octaves = 3});
        const float alpine = smoothstep(300.0F, 2300.0F, heights(col, row));
        talus(col, row) =
            (0.52F + 0.30F * alpine) * (1.0F + (0.5F + 0.9F * alpine) * std::max(rock, -0.35F));
    });
    return talus;
}

void roughen(Grid<float>& heights, float spacing, const LandOptions& options) {
    const ParallelOptions parallel{options.threads, {}, {}};
    for_each_cell(heights.cols(), heights.rows(), parallel, [&](int col, int row) {
        heights(col, row) +=
            0.12F * spacing * (material::unit_hash(options.seed + 31, col, row) - 0.5F);
    });
}

void fit_height(Level& level) {
    const auto heights = level.heights.samples();
    const float top = *std::max_element(heights.begin(), heights.end());
    const float factor = std::clamp(highest / std::max(top, 1.0F), 0.7F, 1.5F);
    for (std::size_t cell = 0; cell < heights.size(); ++cell) {
        heights[cell] *= factor;
        level.uplift.samples()[cell] *= factor;
    }
}

Drainage wear(Level& level, const Grid<std::uint8_t>& outlets, int halvings,
              const LandOptions& options) {
    const float spacing = design_spacing * static_cast<float>(1 << halvings);
    std::vector<float> uplift(level.heights.size());
    std::vector<float> erodibility(level.heights.size());
    constexpr float slope_at_one_square_kilometre = 0.29F;
    for (std::size_t cell = 0; cell < uplift.size(); ++cell) {
        uplift[cell] = max_uplift * level.uplift.samples()[cell];
        erodibility[cell] = max_uplift / (slope_at_one_square_kilometre * 1000.0F) *
                            level.erodibility.samples()[cell];
    }
    FlowRouter router(level.heights.cols(), level.heights.rows(), options.seed + 41,
                      halvings > 0 ? 0.45F : 0.2F);
    const int steps = steps_of_level[halvings];
    for (int step = 0; step < steps && !options.stop.stop_requested(); ++step) {
        router.route(level.heights.samples(), outlets.samples(), options.threads);
        for (int repeat = 0; repeat < 2; ++repeat) { // valleys move little in one step
            erode(level.heights.samples(), router.drainage(),
                  {uplift, erodibility, level.talus.samples(), spacing});
        }
    }
    return std::move(router).drainage();
}

} // namespace

Land make_relief(const LandOptions& options) {
    Level level = first_level(options);
    Grid<std::uint8_t> outlets = low_border(level.uplift);
    for (std::size_t cell = 0; cell < outlets.size(); ++cell) {
        level.heights.samples()[cell] *= outlets.samples()[cell] != 0 ? 0.0F : 1.0F;
    }
    Land land;
    for (int halvings = coarsest; halvings >= 0; --halvings) {
        land.drainage = wear(level, outlets, halvings, options);
        if (options.progress) {
            options.progress(0.6 * std::pow(0.25, halvings)); // each level takes four times as long
        }
        if (halvings == 0 || options.stop.stop_requested()) {
            break;
        }
        if (halvings == 2) {
            fit_height(level);
        }
        const float kilometres = design_spacing * static_cast<float>(1 << halvings) * 0.001F;
        level.talus = talus_of(level.heights, kilometres, options);
        const int size = halvings > 1 ? cells_at(options.size, halvings - 1) : options.size;
        level.heights = warped(level.heights, size, options);
        level.talus = refined(level.talus, size, options.threads);
        level.uplift = refined(level.uplift, size, options.threads);
        level.erodibility = refined(level.erodibility, size, options.threads);
        outlets = refined(outlets, size);
        roughen(level.heights, design_spacing * static_cast<float>(1 << (halvings - 1)), options);
    }
    slide(level.heights, level.talus.samples(), design_spacing, 3, options.threads);
    land.heights = std::move(level.heights);
    return land;
}

} // namespace reljef::terrains::natural
