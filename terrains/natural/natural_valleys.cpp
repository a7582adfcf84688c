#include "terrains/natural/natural_land.h"

#include <cmath>
#include <limits>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "engine/core/parallel_for.h"

namespace reljef::terrains::natural {
namespace {

constexpr float stream_catchment = 1.5F; // km² above which a stream has a floor
constexpr float lake_spacing = 6000.0F;  // metres between lakes, at least
constexpr float lake_depth = 7.0F;       // metres; largest distance of a shore from the lake level

/// The donor with the largest catchment of each cell, or no_cell.
std::vector<std::int32_t> main_donors(const Drainage& drainage) {
    std::vector<std::int32_t> donors(drainage.receiver.size(), no_cell);
    for (const std::int32_t cell : drainage.order) {
        std::int32_t& best = donors[cell_index(drainage.receiver[cell_index(cell)])];
        const bool better =
            best == no_cell || drainage.area[cell_index(cell)] > drainage.area[cell_index(best)];
        if (drainage.receiver[cell_index(cell)] != cell && better) {
            best = cell;
        }
    }
    return donors;
}

/// A piece of a river that a lake may cover: its cells upstream from the outlet.
struct Reach {
    std::vector<std::int32_t> cells;
    std::vector<float> distance; // along the river from the outlet, metres
    float rise = 0.0F;
};

Reach reach_from(std::int32_t outlet, float length, const Land& land,
                 const std::vector<std::int32_t>& donors) {
    Reach reach;
    float distance = 0.0F;
    for (std::int32_t cell = outlet; cell != no_cell && distance < length;
         cell = donors[cell_index(cell)]) {
        reach.cells.push_back(cell);
        reach.distance.push_back(distance);
        distance += design_spacing * land.drainage.distance[cell_index(cell)];
    }
    const auto heights = land.heights.samples();
    reach.rise = distance < length
                     ? std::numeric_limits<float>::max()
                     : heights[cell_index(reach.cells.back())] - heights[cell_index(outlet)];
    return reach;
}

bool may_hold_lake(const Land& land, std::int32_t cell) {
    const float upstream = catchment(land.drainage, cell_index(cell));
    const int cols = land.heights.cols();
    const int margin = cols / 6;
    const int col = cell % cols;
    const int row = cell / cols;
    return upstream > 5.0F && upstream < 150.0F && std::min(col, row) > margin &&
           std::max(col, row) < cols - margin;
}

bool far_from(const std::vector<Reach>& reaches, std::int32_t cell, int cols) {
    const auto is_far = [&](const Reach& reach) {
        const glm::vec2 between{place_of(reach.cells.front(), cols) - place_of(cell, cols)};
        return glm::length(between) * design_spacing > lake_spacing;
    };
    return std::all_of(reaches.begin(), reaches.end(), is_far);
}

/// The flattest reaches of rivers, far from each other.
std::vector<Reach> lake_reaches(const Land& land, const std::vector<std::int32_t>& donors) {
    constexpr float length = 2400.0F;
    constexpr float max_rise = 110.0F;
    std::vector<std::pair<float, std::int32_t>> candidates;
    for (const std::int32_t cell : land.drainage.order) {
        if (cell % 5 == 0 && may_hold_lake(land, cell)) {
            candidates.emplace_back(reach_from(cell, length, land, donors).rise, cell);
        }
    }
    std::sort(candidates.begin(), candidates.end());
    const float kilometres = static_cast<float>(land.heights.cols()) * design_spacing * 0.001F;
    const auto requested = static_cast<std::size_t>(1.0F + kilometres * kilometres / 250.0F);
    std::vector<Reach> reaches;
    for (const auto& [rise, cell] : candidates) {
        if (rise < max_rise && reaches.size() < requested &&
            far_from(reaches, cell, land.heights.cols())) {
            reaches.push_back(reach_from(cell, length, land, donors));
        }
    }
    return reaches;
}

/// Lowers rivers to the level of their lake's outlet. Cells that stand higher are lowered less.
void lower_to_lakes(Land& land, const std::vector<Reach>& reaches) {
    const std::size_t cells = land.heights.size();
    std::vector<float> lowering(cells, 0.0F); // of the river that a cell drains to
    std::vector<float> river(cells, 0.0F);    // old height of that river
    const auto heights = land.heights.samples();
    for (const Reach& reach : reaches) {
        const float level = heights[cell_index(reach.cells.front())];
        for (std::size_t i = 0; i < reach.cells.size(); ++i) {
            const float part = reach.distance[i] / reach.distance.back();
            const float requested = level + reach.rise * std::max(0.0F, 2.0F * part - 1.0F);
            lowering[cell_index(reach.cells[i])] =
                std::max(1.0e-3F, heights[cell_index(reach.cells[i])] - requested);
        }
    }
    for (const std::int32_t cell : land.drainage.order) {
        const std::int32_t receiver = land.drainage.receiver[cell_index(cell)];
        if (lowering[cell_index(cell)] > 0.0F) {
            river[cell_index(cell)] = heights[cell_index(cell)];
        } else {
            lowering[cell_index(cell)] = lowering[cell_index(receiver)];
            river[cell_index(cell)] = river[cell_index(receiver)];
        }
    }
    for (std::size_t cell = 0; cell < cells; ++cell) {
        const float over = heights[cell] - river[cell];
        heights[cell] -= lowering[cell] * (1.0F - smoothstep(0.0F, 300.0F, over));
    }
}

/// The stream cell that each cell drains to.
std::vector<std::int32_t> streams_of(const Drainage& drainage) {
    std::vector<std::int32_t> stream(drainage.receiver.size());
    for (const std::int32_t cell : drainage.order) {
        const std::int32_t receiver = drainage.receiver[cell_index(cell)];
        const bool is_stream = catchment(drainage, cell_index(cell)) > stream_catchment;
        stream[cell_index(cell)] =
            is_stream || receiver == cell ? cell : stream[cell_index(receiver)];
    }
    return stream;
}

/// Metres of alluvium over the rock of a stream's bed.
float alluvium(float square_kilometres) {
    constexpr float min_extent = 1.2247449F; // the root of stream_catchment
    return std::clamp(14.0F * (std::sqrt(square_kilometres) - min_extent), 0.0F, 190.0F);
}

/// The floor level at every stream. The floor of a side valley lies above that of the main valley.
std::vector<float> floor_levels(const Land& land, const std::vector<std::int32_t>& stream) {
    constexpr float slope = 0.002F;
    const auto heights = land.heights.samples();
    std::vector<float> level(heights.begin(), heights.end());
    for (const std::int32_t cell : land.drainage.order) {
        const std::int32_t receiver = land.drainage.receiver[cell_index(cell)];
        if (stream[cell_index(cell)] == cell && receiver != cell) {
            const float run = design_spacing * land.drainage.distance[cell_index(cell)];
            level[cell_index(cell)] = std::max(
                heights[cell_index(cell)] + alluvium(catchment(land.drainage, cell_index(cell))),
                level[cell_index(receiver)] + slope * run);
        }
    }
    return level;
}

/// Makes flat valley floors that blend into the walls.
void fill_floors(Land& land, const std::vector<std::int32_t>& stream, unsigned threads) {
    const std::vector<float> level = floor_levels(land, stream);
    const auto heights = land.heights.samples();
    const std::vector<float> rock(heights.begin(), heights.end());
    Grid<float> floor(land.heights.cols(), land.heights.rows()); // 1 on it, 0 on the walls
    for (std::size_t cell = 0; cell < heights.size(); ++cell) {
        const float bed = level[cell_index(stream[cell])];
        const float depth = std::max(bed - rock[cell_index(stream[cell])], 0.0F);
        const float over = rock[cell] - bed;
        const float soft = 0.25F * depth;
        const float filled = 0.5F * (over + std::sqrt(over * over + soft * soft));
        floor.samples()[cell] = (1.0F - smoothstep(0.2F, 0.7F, filled / (depth + 0.1F))) *
                                smoothstep(6.0F, 30.0F, depth);
        heights[cell] = depth > 0.0F ? bed + filled : heights[cell];
    }
    Grid<float> smooth = land.heights;
    blur(smooth, 2, 3, threads);
    for (std::size_t cell = 0; cell < heights.size(); ++cell) {
        heights[cell] = std::lerp(heights[cell], smooth.samples()[cell], floor.samples()[cell]);
    }
}

void measure_height_above(Land& land, const std::vector<std::int32_t>& stream) {
    const auto heights = land.heights.samples();
    for (std::size_t cell = 0; cell < heights.size(); ++cell) {
        land.above_water.samples()[cell] =
            std::max(0.0F, heights[cell] - heights[cell_index(stream[cell])]);
    }
}

/// Floods the low cells around a river cell, `reach` cells far.
void flood(Land& land, glm::ivec2 river, float level, float reach) {
    const glm::ivec2 last{land.heights.cols() - 1, land.heights.rows() - 1};
    const glm::ivec2 low = glm::max(river - static_cast<int>(reach), glm::ivec2{0});
    const glm::ivec2 high = glm::min(river + static_cast<int>(reach), last);
    for (int row = low.y; row <= high.y; ++row) {
        for (int col = low.x; col <= high.x; ++col) {
            const glm::vec2 away{glm::ivec2{col, row} - river};
            const float near = 1.0F - glm::dot(away, away) / (reach * reach);
            const float over = land.heights(col, row) - level;
            if (near > 0.0F && over < lake_depth * near && over > -lake_depth) {
                land.heights(col, row) = level;
                land.lake(col, row) = 1;
                land.above_water(col, row) = 0.0F;
            }
        }
    }
}

void fill_lakes(Land& land, const std::vector<Reach>& reaches) {
    for (const Reach& reach : reaches) {
        const float level = land.heights.samples()[cell_index(reach.cells.front())];
        for (std::size_t i = 0; i < reach.cells.size(); ++i) {
            const float part = reach.distance[i] / reach.distance.back();
            const float ends =
                smoothstep(-0.05F, 0.15F, part) * (1.0F - smoothstep(0.4F, 0.6F, part));
            const auto random = static_cast<float>(reach.cells[i] % 7);
            if (ends > 0.05F) {
                flood(land, place_of(reach.cells[i], land.heights.cols()), level,
                      ends * (20.0F + random));
            }
        }
    }
}

void blur_row(Grid<float>& to, const Grid<float>& from, int row, int radius) {
    double sum = 0.0; // a running sum in floats would drift along the row
    for (int col = -radius; col <= radius; ++col) {
        sum += from.clamped(col, row);
    }
    const double weight = 1.0 / (2 * radius + 1);
    for (int col = 0; col < from.cols(); ++col) {
        to(col, row) = static_cast<float>(sum * weight);
        sum += static_cast<double>(from.clamped(col + radius + 1, row)) -
               static_cast<double>(from.clamped(col - radius, row));
    }
}

void blur_down(Grid<float>& to, const Grid<float>& from, int row, int radius) {
    const float weight = 1.0F / static_cast<float>(2 * radius + 1);
    std::fill(to.row(row).begin(), to.row(row).end(), 0.0F);
    for (int y = row - radius; y <= row + radius; ++y) {
        for (int col = 0; col < from.cols(); ++col) {
            to(col, row) += weight * from.clamped(col, y);
        }
    }
}

} // namespace

void blur(Grid<float>& values, int radius, int passes, unsigned threads) {
    const ParallelOptions parallel{threads, {}, {}};
    Grid<float> across(values.cols(), values.rows());
    for (int pass = 0; pass < passes; ++pass) {
        parallel_for(
            values.rows(), [&](int row) { blur_row(across, values, row, radius); }, parallel);
        parallel_for(
            values.rows(), [&](int row) { blur_down(values, across, row, radius); }, parallel);
    }
}

void shape_valleys(Land& land, const LandOptions& options) {
    land.above_water = Grid<float>(land.heights.cols(), land.heights.rows());
    land.lake = Grid<std::uint8_t>(land.heights.cols(), land.heights.rows());
    const std::vector<Reach> reaches = lake_reaches(land, main_donors(land.drainage));
    const std::vector<std::int32_t> stream = streams_of(land.drainage);
    lower_to_lakes(land, reaches);
    fill_floors(land, stream, options.threads);
    measure_height_above(land, stream);
    fill_lakes(land, reaches);
}

} // namespace reljef::terrains::natural
