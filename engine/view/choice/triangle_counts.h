#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <glm/vec2.hpp>

#include "engine/core/grid.h"
#include "engine/terrain/mesh/bisection.h"
#include "engine/view/draw_list.h"

namespace reljef::view {

/// Estimates how many triangles a bisection draws with an error, without cutting anything: counts
/// its splits by their errors, for blocks of cells.
class TriangleCounts {
public:
    static constexpr int block_cells = 32;

    TriangleCounts() = default;
    explicit TriangleCounts(const terrain::Bisection& bisection);

    [[nodiscard]] glm::ivec2 blocks() const { return {counts_.cols(), counts_.rows()}; }
    /// About how many triangles a block has if they are off by at most `error` scene metres.
    /// Never less for a smaller error.
    [[nodiscard]] double triangles(glm::ivec2 block, double error) const;

private:
    static constexpr int bins_an_octave = 2;
    static constexpr int lowest_octave = -12; // metres
    static constexpr int bins = 24 * bins_an_octave;
    static constexpr int max_halvings = 8; // of the side of a cell
    // Splits whose error is at least that of the bin.
    using Counts = std::array<std::uint32_t, bins>;

    static double bin_of(double error);
    void add_splits(const terrain::Bisection& bisection, int size, bool on_side);
    void add(const terrain::Bisection& bisection, glm::ivec2 twice_place, int size, bool on_side);

    Grid<Counts> counts_;
};

/// How many triangles keep the error bounds of a list's tiles, by cutting all of them; 0 if there
/// are more than `max`, if no number of them keeps a bound, or if a tile is one of a stream or has
/// none.
std::size_t triangles_for_bound(const DrawList& list, std::size_t max);

} // namespace reljef::view
