#include <array>
#include <cmath>

#include "engine/core/parallel_for.h"
#include "terrains/urban/urban_tile.h"

namespace reljef::terrains::urban {
namespace {

int outside_to_inside(int index, int size, bool tileable) {
    if (tileable) {
        const int rest = index % size;
        return rest < 0 ? rest + size : rest;
    }
    return std::clamp(index, 0, size - 1);
}

// Averages over 2 * radius + 1 samples of a row, transposed.
Grid<float> blurred_rows(const Grid<float>& heights, int radius, const HollowOptions& options) {
    const int size = heights.cols();
    Grid<float> blurred(size, size);
    const auto blur_row = [&](int row) {
        const auto at = [&](int col) {
            return heights(outside_to_inside(col, size, options.tileable), row);
        };
        float sum = 0.0F;
        for (int col = -radius; col <= radius; ++col) {
            sum += at(col);
        }
        const float part = 1.0F / static_cast<float>(2 * radius + 1);
        for (int col = 0; col < size; ++col) {
            blurred(row, col) = sum * part;
            sum += at(col + radius + 1) - at(col - radius);
        }
    };
    parallel_for(size, blur_row, {options.threads, {}, {}});
    return blurred;
}

Grid<float> blurred(const Grid<float>& heights, int radius, const HollowOptions& options) {
    return blurred_rows(blurred_rows(heights, radius, options), radius, options);
}

// The largest reduction to samples of at most about 2 m that keeps the period of the terrain.
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
    for_each_cell(size, size, {threads, {}, {}}, [&](int col, int row) {
        float sum = 0.0F;
        for (int k = 0; k < reduction * reduction; ++k) {
            sum +=
                heights.clamped(col * reduction + k % reduction, row * reduction + k / reduction);
        }
        small(col, row) = sum / static_cast<float>(reduction * reduction);
    });
    return small;
}

// Bilinear interpolation. Beyond an edge the terrain repeats, or its edge samples continue.
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

struct Hollows {
    const Grid<float>& heights;
    const HollowOptions& options;
    int reduction = 1;
    Grid<float> near;
    Grid<float> far;

    [[nodiscard]] float light(int col, int row) const {
        const float here = heights(col, row);
        const float scale = 1.0F / static_cast<float>(reduction);
        const glm::vec2 at = (glm::vec2(col, row) + 0.5F) * scale - 0.5F;
        const float low =
            std::clamp((value_at(near, at, options.tileable) - here) / 16.0F, 0.0F, 1.0F);
        const float deep =
            std::clamp((value_at(far, at, options.tileable) - here) / 30.0F, 0.0F, 1.0F);
        const int reach = std::max(1, static_cast<int>(1.6F / options.spacing));
        return (1.0F - 0.30F * low) * (1.0F - 0.20F * deep) *
               (1.0F - 0.55F * walls(col, row, reach));
    }

private:
    // Share of the sky that samples at a distance of `reach` samples hide.
    [[nodiscard]] float walls(int col, int row, int reach) const {
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
};

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
    for_each_cell(size, size, {options.threads, {}, {}}, [&](int col, int row) {
        Rgba8& color = terrain.color(col, row);
        const float light = hollows.light(col, row) / 255.0F;
        color = encoded(Color(color.r, color.g, color.b) * light);
    });
}

} // namespace reljef::terrains::urban
