#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <glm/gtc/type_precision.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/grid.h"
#include "engine/core/parallel_for.h"
#include "engine/terrain/field/heightfield.h"
#include "engine/terrain/field/placement.h"
#include "engine/terrain/mesh/bending.h"
#include "engine/terrain/mesh/sample_positions.h"
#include "engine/terrain/mesh/upper_bound.h"

namespace reljef::terrain {

/// Vertex positions are counted in steps. Triangles may be smaller than cells. Steps are fine
/// enough for any view: the smallest square of a cell with twist t, two steps wide, is off by t /
/// 2^34. With 1000 pixels per radian, a twist of 1000 m is 0.08 pixels at a millimetre from the
/// eye. A float holds every step of a tile: 128 samples are 2^24 steps.
inline constexpr int steps_per_sample = 1 << 17;
/// A column and row, steps.
using Steps = glm::i64vec2;

inline glm::ivec2 sample_before(Steps place) {
    return glm::ivec2(place / static_cast<std::int64_t>(steps_per_sample));
}
inline Steps steps_of(glm::ivec2 sample) {
    return static_cast<std::int64_t>(steps_per_sample) * Steps(sample);
}
/// Columns and rows, samples.
inline glm::dvec2 samples_of(Steps place) {
    return glm::dvec2(place) / static_cast<double>(steps_per_sample);
}

/// The split of two triangles at the middle of their common longest edge.
struct Split {
    /// Upper bound of the distance between the unsplit triangles, or any descendants, and the
    /// surface, scene metres; infinity if they must be split.
    double error = 0.0;
    /// A bounding sphere of the triangles and their surface, scene metres.
    glm::dvec3 center{0.0};
    double radius = 0.0;
};

/// A split's error and radius, as they are stored.
struct SplitBounds {
    UpperBound error;
    UpperBound radius;
    friend bool operator==(const SplitBounds&, const SplitBounds&) = default;
};

/// The two triangles of a split. Their common edge reaches from `place - along` to `place + along`.
/// Their apexes are `place + across` and `place - across`; the parent splits are there.
struct Halving {
    glm::ivec2 along{0};
    glm::ivec2 across{0};
};
/// `place` is the middle of a square of `size`, or with `on_side` the middle of one of its sides,
/// in the same unit. Precondition: size is even.
Halving halving_at(glm::ivec2 place, int size, bool on_side);

/// The longest-edge bisection of a placed heightfield (Lindstrom and Pascucci 2001). Each tile
/// begins with four triangles around its middle. A split halves a triangle at the middle of its
/// longest edge. Splits are nested: a parent's error and sphere are never smaller than its
/// child's. So a test of each split alone gives triangles that meet edge to edge, across tiles
/// too. Below the samples, bisection continues inside the bilinear cells.
class Bisection {
public:
    /// Both arguments outlive the bisection. The result does not depend on the number of threads;
    /// it is unusable if a stop was requested. Precondition: at least 2×2 samples.
    Bisection(const Heightfield& heightfield, const Placement& placement,
              const ParallelOptions& parallel = {});

    /// Errors and radii of the splits at samples, for a cache file.
    [[nodiscard]] std::vector<SplitBounds> bounds() const;
    static std::size_t bounds_count(glm::ivec2 samples);
    /// The same bisection from its bounds. Precondition: bounds_count() of them.
    Bisection(const Heightfield& heightfield, const Placement& placement,
              std::span<const SplitBounds> bounds, const ParallelOptions& parallel = {});

    /// Whether a sample of the bounds is nested and right: what was read from a file may be
    /// nonsense. Of the splits of less than 16 samples, `seed` chooses one in 64; a checksum of the
    /// file makes them others for each content. Meaningless after a stop request.
    [[nodiscard]] bool is_valid(std::uint32_t seed, const ParallelOptions& parallel = {}) const;

    /// Size of the smallest squares that are split, steps.
    [[nodiscard]] int min_size() const { return min_size_; }
    /// Last sample, steps.
    [[nodiscard]] Steps end() const { return end_; }

    /// `place` is the middle of a square of `size` steps, or with `on_side` the middle of one of
    /// its sides. Precondition: on the heightfield.
    [[nodiscard]] Split split(Steps place, int size, bool on_side) const {
        if (size <= steps_per_sample) {
            return split_in_cell(place, size, on_side);
        }
        const glm::ivec2 sample = sample_before(place);
        const StoredSplit& split = stored(sample, size / steps_per_sample, on_side);
        return {split.bounds.error.value(), positions_.at(sample, split.height),
                split.bounds.radius.value()};
    }

    /// Prefetches the memory that split() reads. Precondition: as split().
    void prefetch(Steps place, int size, bool on_side) const {
        if (size > steps_per_sample) {
            __builtin_prefetch(&stored(sample_before(place), size / steps_per_sample, on_side));
        }
    }

    /// Height of the surface, metres.
    [[nodiscard]] double height(Steps place) const;
    /// Position of the surface, scene metres.
    [[nodiscard]] glm::dvec3 world(Steps place) const;

private:
    // Bounds for the splits inside a cell.
    struct CellBend {
        double middle = 0.0; // error before a split at the middle of a square of size s: × s²/4
        double side = 0.0;   // the same on a side
        double reach = 0.0;  // metres between places one sample apart in col and row
    };
    struct StoredSplit {
        SplitBounds bounds;
        float height = 0.0F; // metres
    };
    class LevelBuilder;
    struct CellsOnly {};

    // Stores the splits in cells; those at samples remain empty.
    Bisection(const Heightfield& heightfield, const Placement& placement,
              const ParallelOptions& parallel, CellsOnly tag);
    static glm::ivec2 splits_in_middles(glm::ivec2 samples, std::size_t level);
    static glm::ivec2 splits_on_sides(glm::ivec2 samples, std::size_t level);
    [[nodiscard]] int min_size_for(const Heightfield& heightfield) const;
    [[nodiscard]] const StoredSplit& stored(glm::ivec2 sample, int size, bool on_side) const {
        const int shift = std::countr_zero(static_cast<unsigned>(size));
        const auto level = static_cast<std::size_t>(shift);
        return on_side ? on_sides_[level](sample.x >> shift, sample.y >> (shift - 1))
                       : in_middles_[level](sample.x >> shift, sample.y >> shift);
    }
    [[nodiscard]] StoredSplit& stored(glm::ivec2 sample, int size, bool on_side) {
        return const_cast<StoredSplit&>(std::as_const(*this).stored(sample, size, on_side));
    }
    void store_cell_rows(int first, int last);
    // Calls `visit(split, sample)` for the splits at samples.
    template <class Self, class Visit> static void for_each_stored(Self& self, const Visit& visit);
    [[nodiscard]] glm::dvec3 position(int col, int row) const {
        return positions_.at({col, row}, heights_(col, row));
    }
    [[nodiscard]] glm::dvec3 position_in_cell(Steps place) const;
    /// Bounds how far position_in_cell() is from the surface, metres.
    [[nodiscard]] double center_error() const { return bending_.curvature + positions_.error(); }
    [[nodiscard]] CellBend bend_of_cell(int col, int row) const;
    [[nodiscard]] Split split_in_cell(Steps place, int size, bool on_side) const;

    GridView<const float> heights_;
    const Placement* placement_;
    Steps end_{0};
    ShorterCells shorter_;
    Bending bending_;
    SamplePositions positions_;
    int min_size_;            // steps
    Grid<SplitBounds> cells_; // of the splits in the middles of cells
    // Of squares of 2, 4, 8 … samples from index 1. A view reads neighbours, which lie side by
    // side.
    static constexpr std::size_t levels = 8;
    std::array<Grid<StoredSplit>, levels> in_middles_; // (col, row) of the square
    std::array<Grid<StoredSplit>, levels> on_sides_;   // two rows for each row of squares
};

} // namespace reljef::terrain
