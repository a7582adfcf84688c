#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/grid.h"
#include "engine/core/parallel_for.h"
#include "engine/terrain/field/heightfield.h"
#include "engine/terrain/field/placement.h"

namespace reljef::terrain {

/// Places of vertices are counted in steps: so many to a sample, for triangles smaller than cells.
inline constexpr int steps_per_sample = 64;

/// What hangs on splitting the two triangles whose common longest edge has its middle here.
struct Split {
    /// Metres of the scene from any point of the unsplit triangles, or of any below them, to where
    /// it belongs on the surface; infinity where they must be split.
    double error = 0.0;
    /// A ball, scene metres, that holds those triangles and the surface where they are.
    glm::dvec3 center{0.0};
    double radius = 0.0;
};

/// How a split halves its two triangles: their common edge reaches from `place - along` to
/// `place + along`, and their apexes, where the splits are that it needs, are `place + across` and
/// `place - across`.
struct Halving {
    glm::ivec2 along{0};
    glm::ivec2 across{0};
};
/// At the middle of a square of `size`, or with `on_side` in the middle of one of its sides; place
/// and size in the same unit. Precondition: size is even.
Halving halving_at(glm::ivec2 place, int size, bool on_side);

/// The longest-edge bisection of a placed heightfield (Lindstrom and Pascucci 2001): each tile
/// begins with four triangles around its middle, and a triangle is halved at the middle of its
/// longest edge. Splits are nested: none has a smaller error or a smaller ball than one that needs
/// it, so that any choice "error and ball are too much for the view", made for each split by
/// itself, gives triangles that meet edge to edge, across tiles too. Below the samples bisection
/// goes on into the bilinear cells.
class Bisection {
public:
    /// Precondition: at least 2×2 samples; both outlive the bisection. The same for any number of
    /// threads. Once a stop is asked for it is of no use any more, and soon made.
    Bisection(const Heightfield& heightfield, const Placement& placement,
              const ParallelOptions& parallel = {});

    /// What takes long to find, as numbers that a file may keep: errors and radii of the splits at
    /// samples.
    [[nodiscard]] std::vector<float> bounds() const;
    static std::size_t bounds_count(glm::ivec2 samples);
    /// The same bisection once more, from its bounds. Precondition: bounds_count() of them.
    Bisection(const Heightfield& heightfield, const Placement& placement,
              std::span<const float> bounds, const ParallelOptions& parallel = {});

    /// Last sample, steps.
    [[nodiscard]] glm::ivec2 end() const { return end_; }

    /// The split at `place` of triangles in a square of `size` steps: at its middle, or with
    /// `on_side` in the middle of one of its sides. Precondition: on the heightfield.
    [[nodiscard]] Split split(glm::ivec2 place, int size, bool on_side) const {
        if (size <= steps_per_sample) {
            return split_in_cell(place, size, on_side);
        }
        const glm::ivec2 sample = place / steps_per_sample;
        const KeptSplit& split = kept(sample, size / steps_per_sample, on_side);
        return {split.error, place_of(sample, split), split.radius};
    }

    /// Asks for what split() reads to be at hand soon. Precondition: as split().
    void prefetch(glm::ivec2 place, int size, bool on_side) const {
        if (size > steps_per_sample) {
            __builtin_prefetch(&kept(place / steps_per_sample, size / steps_per_sample, on_side));
        }
    }

    /// Height of the surface, metres.
    [[nodiscard]] double height(glm::ivec2 place) const;
    /// Where that lies, scene metres.
    [[nodiscard]] glm::dvec3 world(glm::ivec2 place) const;

private:
    // How the placement bends the ground, see bisection.cpp.
    struct Bending {
        double stretch = 0.0;   // metres from any place to another a sample away in col and row
        double curvature = 0.0; // metres/sample², second derivative in any direction
        double turn = 0.0;      // radians/sample, of the vertical
    };
    // What splits inside a cell need of it, metres.
    struct CellBend {
        double middle = 0.0; // error before a split at the middle of a square of size s: × s²/4
        double side = 0.0;   // the same on a side
        double reach = 0.0;  // metres between places a sample away in col and row
    };
    struct KeptSplit {
        float error = 0.0F;
        float radius = 0.0F;
        float height = 0.0F; // metres
    };
    class LevelBuilder;
    struct Empty {};

    Bisection(const Heightfield& heightfield, const Placement& placement, Empty empty);
    static glm::ivec2 splits_in_middles(glm::ivec2 samples, std::size_t level);
    static glm::ivec2 splits_on_sides(glm::ivec2 samples, std::size_t level);
    static Bending bending_of(const Heightfield& heightfield, const Placement& placement);
    void keep_places(const ParallelOptions& parallel);
    void make_levels();
    [[nodiscard]] const KeptSplit& kept(glm::ivec2 sample, int size, bool on_side) const {
        const int shift = std::countr_zero(static_cast<unsigned>(size));
        const auto level = static_cast<std::size_t>(shift);
        return on_side ? on_sides_[level](sample.x >> shift, sample.y >> (shift - 1))
                       : in_middles_[level](sample.x >> shift, sample.y >> shift);
    }
    [[nodiscard]] KeptSplit& kept(glm::ivec2 sample, int size, bool on_side) {
        return const_cast<KeptSplit&>(std::as_const(*this).kept(sample, size, on_side));
    }
    void keep_cells(const ParallelOptions& parallel);
    void keep_cell_rows(int first, int last);
    // Calls `visit(split, sample)` for those at samples.
    template <class Self, class Visit> static void for_each_kept(Self& self, const Visit& visit);
    [[nodiscard]] glm::dvec3 place_of(int col, int row) const;
    [[nodiscard]] glm::dvec3 place_of(glm::ivec2 sample, const KeptSplit& split) const {
        return offsets_.empty()
                   ? glm::dvec3((sample.x - middle_.x) * metres_.x,
                                (middle_.y - sample.y) * metres_.y, split.height * metres_.z)
                   : place_of(sample.x, sample.y);
    }
    [[nodiscard]] glm::dvec3 place_in_cell(glm::ivec2 place) const;
    [[nodiscard]] CellBend bend_of_cell(int col, int row) const;
    [[nodiscard]] Split split_in_cell(glm::ivec2 place, int size, bool on_side) const;

    GridView<const float> heights_;
    const Placement* placement_;
    glm::ivec2 end_{0};
    glm::dvec2 middle_{0.0}; // sample; on a plane
    glm::dvec3 metres_{1.0}; // scene metres by sample, sample and metre; on a plane
    Bending bending_;
    // Of squares of 1, 2, 4 … samples: those a view asks for together lie side by side.
    static constexpr std::size_t levels = 8;
    std::array<Grid<KeptSplit>, levels> in_middles_; // (col, row) of the square
    std::array<Grid<KeptSplit>, levels> on_sides_;   // row: of the side, two a square
    Grid<glm::vec3> offsets_;  // of samples on an ellipsoid, from their tile's origin
    Grid<glm::dvec3> origins_; // of tiles
};

} // namespace reljef::terrain
