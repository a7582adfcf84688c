#include "terrains/urban/urban_light.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/parallel_for.h"

namespace reljef::terrains::urban {
namespace {

int outside_to_inside(int index, int size, bool tileable) {
    if (tileable) {
        const int rest = index % size;
        return rest < 0 ? rest + size : rest;
    }
    return std::clamp(index, 0, size - 1);
}

// The average over a square of 2 * radius + 1 samples, of what `at(k)` gives for k in [0, size).
template <class At, class Put>
void slide(int size, int radius, bool tileable, const At& at, const Put& put) {
    float sum = 0.0F;
    for (int k = -radius; k <= radius; ++k) {
        sum += at(outside_to_inside(k, size, tileable));
    }
    const float part = 1.0F / static_cast<float>(2 * radius + 1);
    for (int k = 0; k < size; ++k) {
        put(k, sum * part);
        sum += at(outside_to_inside(k + radius + 1, size, tileable)) -
               at(outside_to_inside(k - radius, size, tileable));
    }
}

Grid<float> blurred(const Grid<float>& heights, int radius, const HollowOptions& options) {
    const int size = heights.cols();
    Grid<float> rows(size, size);
    Grid<float> both(size, size);
    parallel_for(size,
                 [&](int row) {
                     slide(
                         size, radius, options.tileable, [&](int k) { return heights(k, row); },
                         [&](int k, float value) { rows(k, row) = value; });
                 },
                 {options.threads, {}, {}});
    parallel_for(size,
                 [&](int col) {
                     slide(
                         size, radius, options.tileable, [&](int k) { return rows(col, k); },
                         [&](int k, float value) { both(col, k) = value; });
                 },
                 {options.threads, {}, {}});
    return both;
}

// The largest reduction to samples of at most about 2 m that keeps a tile's period.
int reduction_of(int size, const HollowOptions& options) {
    int reduction = std::clamp(static_cast<int>(2.0F / options.spacing), 1, 8);
    while (options.tileable && size % reduction != 0) {
        --reduction;
    }
    return reduction;
}

/// Averages of `reduction` by `reduction` samples.
Grid<float> reduced(const Grid<float>& heights, int reduction, unsigned threads) {
    const int size = (heights.cols() + reduction - 1) / reduction;
    Grid<float> small(size, size);
    parallel_for(size,
                 [&](int row) {
                     for (int col = 0; col < size; ++col) {
                         float sum = 0.0F;
                         for (int k = 0; k < reduction * reduction; ++k) {
                             sum += heights.clamped(col * reduction + k % reduction,
                                                    row * reduction + k / reduction);
                         }
                         small(col, row) = sum / static_cast<float>(reduction * reduction);
                     }
                 },
                 {threads, {}, {}});
    return small;
}

// Bilinear, with the other side or the edge itself beyond an edge.
float value_at(const Grid<float>& grid, glm::vec2 at, bool tileable) {
    const float x = std::floor(at.x);
    const float y = std::floor(at.y);
    const int size = grid.cols();
    const int x0 = outside_to_inside(static_cast<int>(x), size, tileable);
    const int y0 = outside_to_inside(static_cast<int>(y), size, tileable);
    const int x1 = outside_to_inside(static_cast<int>(x) + 1, size, tileable);
    const int y1 = outside_to_inside(static_cast<int>(y) + 1, size, tileable);
    const float top = grid(x0, y0) + (grid(x1, y0) - grid(x0, y0)) * (at.x - x);
    const float low = grid(x0, y1) + (grid(x1, y1) - grid(x0, y1)) * (at.x - x);
    return top + (low - top) * (at.y - y);
}

/// The heights' surroundings, ready for every sample.
struct Hollows {
    const Grid<float>& heights;
    const HollowOptions& options;
    int reduction = 1;
    Grid<float> near;
    Grid<float> far;

    [[nodiscard]] float light(int col, int row) const;

private:
    [[nodiscard]] float walls(int col, int row, int reach) const;
};

// Part of the sky that what stands `reach` samples away hides.
float Hollows::walls(int col, int row, int reach) const {
    constexpr std::array<std::array<int, 2>, 8> around{
        {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}}};
    const float here = heights(col, row);
    const int size = heights.cols();
    const float run = static_cast<float>(reach) * options.spacing;
    float hidden = 0.0F;
    for (const auto& [x, y] : around) {
        const float there = heights(outside_to_inside(col + x * reach, size, options.tileable),
                                    outside_to_inside(row + y * reach, size, options.tileable));
        const float rise = std::clamp(there - here, 0.0F, 4.0F * run);
        hidden += rise / (rise + 2.0F * run);
    }
    return hidden * 0.125F;
}

float Hollows::light(int col, int row) const {
    const float here = heights(col, row);
    const float scale = 1.0F / static_cast<float>(reduction);
    const glm::vec2 at{(static_cast<float>(col) + 0.5F) * scale - 0.5F,
                       (static_cast<float>(row) + 0.5F) * scale - 0.5F};
    const float low = std::clamp((value_at(near, at, options.tileable) - here) / 16.0F, 0.0F, 1.0F);
    const float deep = std::clamp((value_at(far, at, options.tileable) - here) / 30.0F, 0.0F, 1.0F);
    const int reach = std::max(1, static_cast<int>(1.6F / options.spacing));
    return (1.0F - 0.30F * low) * (1.0F - 0.20F * deep) * (1.0F - 0.55F * walls(col, row, reach));
}

} // namespace

Rgba8 encoded(const Color& color) {
    const auto channel = [](float value) {
        return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0F, 1.0F) * 255.0F));
    };
    return {channel(color.x), channel(color.y), channel(color.z), 255};
}

void darken_hollows(terrain::Terrain& terrain, const HollowOptions& options) {
    const Grid<float>& heights = terrain.heightfield.heights;
    const int size = heights.cols();
    const int reduction = reduction_of(size, options);
    const Grid<float> small = reduced(heights, reduction, options.threads);
    const float step = static_cast<float>(reduction) * options.spacing;
    const auto radius = [&](float metres) {
        return std::clamp(static_cast<int>(std::lround(metres / step)), 1,
                          std::max(1, small.cols() / 2));
    };
    const Hollows hollows{heights, options, reduction, blurred(small, radius(5.0F), options),
                          blurred(small, radius(16.0F), options)};
    parallel_for(size,
                 [&](int row) {
                     for (int col = 0; col < size; ++col) {
                         Rgba8& color = terrain.color(col, row);
                         const float light = hollows.light(col, row) / 255.0F;
                         color =
                             encoded(Color{static_cast<float>(color.r), static_cast<float>(color.g),
                                           static_cast<float>(color.b)} *
                                     light);
                     }
                 },
                 {options.threads, {}, {}});
}

} // namespace reljef::terrains::urban
