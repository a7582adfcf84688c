#include "engine/view/choice/triangle_counts.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <map>
#include <variant>

#include <glm/common.hpp>

#include "engine/core/parallel_for.h"
#include "engine/terrain/mesh/tile_layout.h"
#include "engine/view/triangles/tile_cut.h"

namespace reljef::view {

// The places of splits are counted in half samples.

TriangleCounts::TriangleCounts(const terrain::Bisection& bisection) {
    const glm::ivec2 cells = terrain::sample_before(bisection.end());
    const glm::ivec2 blocks = (cells + block_cells - 1) / block_cells;
    counts_ = Grid<Counts>(blocks.x, blocks.y, Counts{});
    for (int size = terrain::tile_cells; size >= 2; size /= 2) {
        add_splits(bisection, size, true);
        if (size < terrain::tile_cells) {
            add_splits(bisection, size, false);
        }
    }
    add_splits(bisection, 1, false);
    for (int row = 0; row < blocks.y; ++row) {
        for (int col = 0; col < blocks.x; ++col) {
            Counts& counts = counts_(col, row);
            for (std::size_t bin = counts.size() - 1; bin > 0; --bin) {
                counts[bin - 1] += counts[bin];
            }
        }
    }
}

void TriangleCounts::add_splits(const terrain::Bisection& bisection, int size, bool on_side) {
    const glm::ivec2 end = 2 * terrain::sample_before(bisection.end());
    const int step = on_side ? size : 2 * size;
    for (int row = on_side ? 0 : size; row <= end.y; row += step) {
        const bool begins_at_corner = on_side && row % (2 * size) != 0;
        for (int col = begins_at_corner ? 0 : size; col <= end.x; col += 2 * size) {
            add(bisection, {col, row}, size, on_side);
        }
    }
}

void TriangleCounts::add(const terrain::Bisection& bisection, glm::ivec2 twice_place, int size,
                         bool on_side) {
    constexpr auto half = static_cast<std::int64_t>(terrain::steps_per_sample / 2);
    const terrain::Split split = bisection.split(half * terrain::Steps(twice_place),
                                                 size * terrain::steps_per_sample, on_side);
    const double bin = bin_of(split.error); // infinite for no error, and for one without a bound
    if (bin < 0.0) {
        return;
    }
    const glm::ivec2 block = glm::min(twice_place / (2 * block_cells), blocks() - 1);
    Counts& counts = counts_(block.x, block.y);
    auto at = static_cast<int>(std::min(bin, bins - 1.0));
    ++counts[static_cast<std::size_t>(at)];
    if (size > 1 || std::isinf(split.error)) {
        return;
    }
    // Inside a cell, squares of half the side have a quarter of the error: four middles, and two
    // sides of the square around them.
    constexpr int bins_of_a_quarter = 2 * bins_an_octave;
    std::uint32_t splits = 6;
    for (int halving = 1; halving <= max_halvings && at >= bins_of_a_quarter; ++halving) {
        at -= bins_of_a_quarter;
        counts[static_cast<std::size_t>(at)] += splits;
        splits *= 4;
    }
}

double TriangleCounts::bin_of(double error) {
    return error > 0.0 ? bins_an_octave * (std::log2(error) - lowest_octave)
                       : -std::numeric_limits<double>::infinity();
}

// A split halves two triangles. Between the errors of two bins, the number is interpolated.
double TriangleCounts::triangles(glm::ivec2 block, double error) const {
    const Counts& counts = counts_(block.x, block.y);
    const double at = std::clamp(bin_of(error), 0.0, bins - 1.0);
    const auto low = static_cast<std::size_t>(at);
    const std::size_t high = std::min(low + 1, counts.size() - 1);
    return 2.0 + 2.0 * std::lerp(static_cast<double>(counts[low]),
                                 static_cast<double>(counts[high]), at - static_cast<double>(low));
}

std::size_t triangles_for_bound(const DrawList& list, std::size_t max) {
    const auto has_bound = [&](const TileDraw& draw) {
        const auto& coarseness = list.terrains[draw.node].coarseness;
        return draw.tile->borrows && coarseness &&
               std::holds_alternative<terrain::ErrorView>(*coarseness);
    };
    if (!std::all_of(list.tiles.begin(), list.tiles.end(), has_bound)) {
        return 0;
    }
    std::map<const scene::TerrainNode*, terrain::Bisection> made;
    for (const TileDraw& draw : list.tiles) {
        if (draw.terrain->bisection == nullptr && !made.contains(draw.terrain)) {
            const scene::TerrainSurface& surface = *draw.terrain->surface;
            made.emplace(draw.terrain,
                         terrain::Bisection(surface.heightfield(), surface.placement()));
        }
    }
    terrain::TriangleBudget budget(max);
    std::atomic<bool> are_enough = true;
    parallel_for(static_cast<int>(list.tiles.size()), [&](int i) {
        const TileDraw& draw = list.tiles[static_cast<std::size_t>(i)];
        const terrain::Bisection& bisection =
            draw.terrain->bisection != nullptr ? *draw.terrain->bisection : made.at(draw.terrain);
        const auto& bound = std::get<terrain::ErrorView>(*list.terrains[draw.node].coarseness);
        CutOptions options;
        options.triangle_error = draw.triangle_error;
        const terrain::ErrorView view = triangle_view(bound, options);
        const auto cut = terrain::triangulate(bisection, surface_of(draw).samples, view, &budget);
        if (cut.error > view.max_error || view.exceeded_by_rounding) {
            are_enough = false;
        }
    });
    return budget.is_exceeded() || !are_enough ? 0 : budget.count();
}

} // namespace reljef::view
