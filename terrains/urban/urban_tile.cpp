#include "terrains/urban/urban_tile.h"

#include <cmath>

#include "engine/core/grid.h"

namespace reljef::terrains::urban {
namespace {

struct NoiseScale {
    float cell = 2.0F; ///< metres
    int step = 4;      ///< samples between those that are computed
    int octaves = 2;
    std::uint32_t seed = 0;
};

// Noise at every step-th sample of the raster, bilinear between them.
std::vector<float> noise_of(const Raster& raster, const Tile& tile, const NoiseScale& scale) {
    const float extent = static_cast<float>(raster.size) * raster.spacing;
    const auto period = std::max(1, static_cast<std::int32_t>(std::lround(extent / scale.cell)));
    const float per_sample = static_cast<float>(period) / static_cast<float>(raster.size);
    const int nodes_x = (tile.cols - 1) / scale.step + 2;
    const int nodes_y = (tile.rows - 1) / scale.step + 2;
    Grid<float> nodes(nodes_x, nodes_y);
    for (int y = 0; y < nodes_y; ++y) {
        for (int x = 0; x < nodes_x; ++x) {
            const glm::vec2 sample(tile.col + x * scale.step, tile.row + y * scale.step);
            nodes(x, y) = material::fractal_noise(scale.seed, sample * per_sample,
                                                  {scale.octaves, 0.6F, period});
        }
    }
    std::vector<float> values(tile.place.size());
    const float part = 1.0F / static_cast<float>(scale.step);
    for (int y = 0; y < tile.rows; ++y) {
        const int ny = y / scale.step;
        const float fy = static_cast<float>(y - ny * scale.step) * part;
        for (int x = 0; x < tile.cols; ++x) {
            const int nx = x / scale.step;
            const float fx = static_cast<float>(x - nx * scale.step) * part;
            const float top = nodes(nx, ny) + (nodes(nx + 1, ny) - nodes(nx, ny)) * fx;
            const float low = nodes(nx, ny + 1) + (nodes(nx + 1, ny + 1) - nodes(nx, ny + 1)) * fx;
            values[tile.index(x, y)] = top + (low - top) * fy;
        }
    }
    return values;
}

void place_samples(Tile& tile, const Raster& raster, const Warp& warp) {
    for (int y = 0; y < tile.rows; ++y) {
        for (int x = 0; x < tile.cols; ++x) {
            const std::size_t i = tile.index(x, y);
            const glm::vec2 sample(tile.col + x, tile.row + y);
            tile.place[i] = warp.city_from_ground(raster.origin + sample * raster.spacing);
            tile.bounds.add(tile.place[i]);
            tile.grain[i] =
                2.0F * material::unit_hash(raster.seed, tile.col + x, tile.row + y) - 1.0F;
        }
    }
}

int clamped_floor(float value, int high) {
    return static_cast<int>(std::clamp(std::floor(value), 0.0F, static_cast<float>(high)));
}

} // namespace

Box city_bounds(const Raster& raster, const Warp& warp) {
    Box box;
    const float side = raster.spacing * static_cast<float>(raster.size);
    constexpr int steps = 64;
    for (int i = 0; i <= steps; ++i) {
        const float along = side * static_cast<float>(i) / steps;
        for (const glm::vec2 place : {glm::vec2(along, 0.0F), glm::vec2(along, side),
                                      glm::vec2(0.0F, along), glm::vec2(side, along)}) {
            box.add(warp.city_from_ground(raster.origin + place), side / steps);
        }
    }
    return box;
}

Tile make_tile(const Raster& raster, const Warp& warp, int col, int row, int cols, int rows) {
    Tile tile;
    tile.col = col;
    tile.row = row;
    tile.cols = cols;
    tile.rows = rows;
    tile.spacing = raster.spacing;
    tile.walls = raster.walls;
    tile.origin = raster.origin + glm::vec2(col, row) * raster.spacing;
    const std::size_t count = static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows);
    tile.place.resize(count);
    tile.color.resize(count, Color{0.4F, 0.4F, 0.4F});
    tile.height.resize(count);
    tile.bare.resize(count, 1.0F);
    tile.built.resize(count);
    tile.planted.resize(count);
    tile.grain.resize(count);
    place_samples(tile, raster, warp);
    tile.fine = noise_of(raster, tile, {2.6F, 2, 2, raster.seed + 1U});
    tile.broad = noise_of(raster, tile, {17.0F, 4, 3, raster.seed + 9U});
    return tile;
}

Span span_of(const Tile& tile, const Warp& warp, const Box& box) {
    if (box.low.x > tile.bounds.high.x || box.low.y > tile.bounds.high.y ||
        box.high.x < tile.bounds.low.x || box.high.y < tile.bounds.low.y) {
        return {};
    }
    const glm::vec2 center = warp.ground_from_city((box.low + box.high) * 0.5F) - tile.origin;
    const glm::vec2 half = (box.high - box.low) * 0.5F;
    const float slack = Warp::strain / (1.0F - Warp::strain) * (half.x + half.y) + tile.spacing;
    const float scale = 1.0F / tile.spacing;
    return {clamped_floor((center.x - half.x - slack) * scale, tile.cols),
            clamped_floor((center.y - half.y - slack) * scale, tile.rows),
            clamped_floor((center.x + half.x + slack) * scale + 2.0F, tile.cols),
            clamped_floor((center.y + half.y + slack) * scale + 2.0F, tile.rows)};
}

} // namespace reljef::terrains::urban
