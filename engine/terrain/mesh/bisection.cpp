#include "engine/terrain/mesh/bisection.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/terrain/mesh/tile_layout.h"
#include "engine/terrain/mesh/triangle_error.h"

// Error of a triangle. On a plane it is triangle_error() times the exaggeration X. On an ellipsoid
// a sample lies at G + X h N with the ground G and the vertical N. A point with the barycentric
// weights w has the error
//   (Σ w G - G) + X Σ w (h - m) (N_corner - N) + X m (Σ w N - N) + X (Σ w h - h) N
// for any height m. H is the longest edge in samples, C bounds the second derivatives.
// - Terms 1 and 3 are together at most H² C / 8: the corners of a right triangle lie on a circle of
//   radius H/2, and a linear interpolant has an error of at most half its square times C.
// - Term 2 is at most X R/2 · T · H/2, with m in the middle of the corners' heights, which span R,
//   and verticals that turn by T per sample: Σ w |corner - point| <= H/2, because its square is at
//   most Σ w |corner - point|² = (H/2)² - |point - middle|².
// Where the triangle spans cells of two lengths, the ground is a smooth map of places among equal
// cells. Corners are nearer to each other there, so that the bounds above hold; and the points of
// the triangle are shifted by less than what the shorter cell lacks, times the map's derivative.
//
// In a cell with twist t, half a square of size s <= 1 has the error X |t| s²/4 (the parabola along
// its diagonal), and a quarter of that after one more split. Heights in the square span at most
// g s; g is the largest difference of the cell along columns plus that along rows. This gives
//   s²/4 (X |t|   + C   + √2 X g T) before the split at its middle (H = √2 s) and
//   s²/4 (X |t|/4 + C/2 +    X g T) before those on its sides (H = s).
//
// Descendants of a split in the middle of a square of size s lie within 1.5 s of it in col and row,
// those of a split on a side within 1 s (s/2 + s/4 + s/4 + s/8 + …). So the maximum over the cells
// within that distance bounds all descendants. At samples it is the maximum of the four children.

namespace reljef::terrain {
namespace {

constexpr double must_split = std::numeric_limits<double>::infinity();

// Spheres grow by this factor from child to parent, for the rounding of sums and positions.
constexpr double sphere_growth = 1.0 + 0x1p-20;

// Error of the spheres' centres on an ellipsoid, of the distance between samples: less than the
// smallest squares inside cells.
constexpr double max_share_of_step = 0x1p-12;

// Calls `body(first, last)` for runs of `at_once` of [0, count), from several threads.
template <class Body>
void for_runs(int count, int at_once, const ParallelOptions& parallel, const Body& body) {
    parallel_for((count + at_once - 1) / at_once,
                 [&](int index) { body(index * at_once, std::min(count, (index + 1) * at_once)); },
                 {parallel.threads, parallel.stop, {}});
}

// A check of all splits would take half as long as their computation. These take about 5 %.
constexpr int min_size_all_nested = 16;
bool is_checked(glm::uvec2 place, std::uint32_t seed) {
    return (2654435761U * ((place.x + 40503U * place.y) ^ seed)) >> 26U == 0; // one in 64, by Knuth
}

constexpr int samples_at_once = 16; // rows of samples per work item

// Of the cell that contains a place; negative outside.
glm::ivec2 cell_at(Steps place) {
    static_assert(std::has_single_bit(static_cast<unsigned>(steps_per_sample)));
    constexpr int shift = std::countr_zero(static_cast<unsigned>(steps_per_sample));
    return {static_cast<int>(place.x >> shift), static_cast<int>(place.y >> shift)};
}

bool is_inside(GridView<const float> heights, glm::ivec2 sample) {
    return sample.x >= 0 && sample.y >= 0 && sample.x < heights.cols() && sample.y < heights.rows();
}

// Whether the bounding box of the triangle overlaps the heightfield.
bool reaches_in(GridView<const float> heights, const SampleTriangle& triangle) {
    const glm::ivec2 low = glm::min(triangle[0], glm::min(triangle[1], triangle[2]));
    const glm::ivec2 high = glm::max(triangle[0], glm::max(triangle[1], triangle[2]));
    return high.x > 0 && high.y > 0 && low.x < heights.cols() - 1 && low.y < heights.rows() - 1;
}

// The two triangles of a split at a sample; apexes first.
std::array<SampleTriangle, 2> halved_at(glm::ivec2 place, int size, bool on_side) {
    const auto [along, across] = halving_at(place, size, on_side);
    return {SampleTriangle{place + across, place - along, place + along},
            SampleTriangle{place - across, place - along, place + along}};
}

} // namespace

Halving halving_at(glm::ivec2 place, int size, bool on_side) {
    const int half = size / 2;
    if (on_side) {
        const glm::ivec2 along = place.y % size == 0 ? glm::ivec2(half, 0) : glm::ivec2(0, half);
        return {along, {along.y, along.x}};
    }
    // The diagonal of a square ends in the middle of its parent square.
    const bool falls = (place.x / size + place.y / size) % 2 == 0;
    const int down = falls ? half : -half;
    return {{half, down}, {half, -down}};
}

// Computes the errors and spheres of one level of splits from their children.
class Bisection::LevelBuilder {
public:
    LevelBuilder(const Bisection& bisection, int size, bool on_side)
        : bisection_(bisection), size_(size), on_side_(on_side) {}

    void build(Bisection& result, const ParallelOptions& parallel) const {
        for_each_split(parallel, [&](glm::ivec2 place) {
            SplitBounds bounds = enclosing_children(place);
            bounds.error = std::max(bounds.error, own_error(place));
            result.stored(place, size_, on_side_) = {bounds, bisection_.heights_(place.x, place.y)};
        });
    }

    [[nodiscard]] bool is_valid(std::uint32_t seed, const ParallelOptions& parallel) const {
        std::atomic<bool> valid = true;
        for_each_split(parallel, [&](glm::ivec2 place) {
            const bool checks_own = is_checked(glm::uvec2(place), seed);
            if (checks_own || size_ >= min_size_all_nested) {
                const SplitBounds& found = bisection_.stored(place, size_, on_side_).bounds;
                const SplitBounds minimum = enclosing_children(place);
                const UpperBound own = checks_own ? own_error(place) : found.error;
                if (found.error != std::max(minimum.error, own) || found.radius != minimum.radius) {
                    valid = false;
                }
            }
        });
        return valid;
    }

private:
    template <class Visit>
    void for_each_split(const ParallelOptions& parallel, const Visit& visit) const {
        const int half = size_ / 2;
        const int first_row = on_side_ ? 0 : half;
        const int step = on_side_ ? half : size_;
        const int rows = bisection_.heights_.rows();
        const int count = rows > first_row ? (rows - 1 - first_row) / step + 1 : 0;
        for_runs(count, std::max(samples_at_once / step, 1), parallel, [&](int first, int last) {
            for (int i = first; i < last; ++i) {
                const int row = first_row + i * step;
                const bool begins_at_corner = on_side_ && row % size_ != 0;
                for (int col = begins_at_corner ? 0 : half; col < bisection_.heights_.cols();
                     col += size_) {
                    visit(glm::ivec2(col, row));
                }
            }
        });
    }

    [[nodiscard]] SplitBounds enclosing_children(glm::ivec2 place) const {
        double error = 0.0;
        double radius = 0.0;
        const glm::dvec3 center = bisection_.position(place.x, place.y);
        for_each_child(place, [&](const Split& child) {
            error = std::max(error, child.error);
            radius = std::max(radius, glm::distance(center, child.center) + child.radius);
        });
        return {UpperBound(error), UpperBound(radius * sphere_growth)};
    }

    [[nodiscard]] UpperBound own_error(glm::ivec2 place) const {
        double error = 0.0;
        for (const SampleTriangle& triangle : halved_at(place, size_, on_side_)) {
            error = std::max(error, error_of(triangle));
        }
        return UpperBound(error);
    }

    double error_of(const SampleTriangle& triangle) const {
        const GridView<const float> heights = bisection_.heights_;
        if (!std::all_of(triangle.begin(), triangle.end(),
                         [&](glm::ivec2 corner) { return is_inside(heights, corner); })) {
            return reaches_in(heights, triangle) ? must_split : 0.0;
        }
        const double exaggeration = bisection_.placement_->exaggeration();
        double error = exaggeration * triangle_error(heights, triangle) +
                       bisection_.bending_.stretch * shift_of(triangle);
        if (bisection_.bending_.curvature > 0.0) {
            const auto at = [&](std::size_t i) { return heights(triangle[i].x, triangle[i].y); };
            const auto [low, high] = std::minmax({at(0), at(1), at(2)});
            const double longest = glm::length(glm::dvec2(triangle[2] - triangle[1]));
            error += 0.125 * longest * longest * bisection_.bending_.curvature +
                     0.25 * exaggeration * (static_cast<double>(high) - low) * longest *
                         bisection_.bending_.turn;
        }
        return error;
    }

    // Of the triangle's places from those of equal cells, cells.
    [[nodiscard]] double shift_of(const SampleTriangle& triangle) const {
        return bisection_.shorter_.shift_between(
            glm::min(triangle[0], glm::min(triangle[1], triangle[2])),
            glm::max(triangle[0], glm::max(triangle[1], triangle[2])));
    }

    // The up to four children on the heightfield.
    template <class Visit> void for_each_child(glm::ivec2 place, const Visit& visit) const {
        const int reach = steps_per_sample * size_ / (on_side_ ? 4 : 2);
        const int size = steps_per_sample * size_ / (on_side_ ? 2 : 1);
        for (int i = 0; i < 4; ++i) {
            const glm::ivec2 offset = on_side_ ? glm::ivec2(i % 2 == 0 ? -1 : 1, i < 2 ? -1 : 1)
                                               : glm::ivec2((i - 1) % 2, (i - 2) % 2);
            const Steps child = steps_of(place) + Steps(reach * offset);
            if (child.x >= 0 && child.y >= 0 && child.x <= bisection_.end_.x &&
                child.y <= bisection_.end_.y) {
                visit(bisection_.split(child, size, !on_side_));
            }
        }
    }

    const Bisection& bisection_;
    int size_; // samples
    bool on_side_;
};

Bisection::Bisection(const Heightfield& heightfield, const Placement& placement,
                     const ParallelOptions& parallel, CellsOnly)
    : heights_(heightfield.heights.view()), placement_(&placement),
      end_(steps_of({heights_.cols() - 1, heights_.rows() - 1})), shorter_(heightfield, placement),
      bending_(bending_of(heightfield, placement, shorter_)),
      positions_(heightfield, placement, bending_.curvature, max_share_of_step * bending_.stretch),
      min_size_(min_size_for(heightfield)) {
    check(end_.x > 0 && end_.y > 0, "a bisection needs at least 2x2 samples");
    const glm::ivec2 samples(heights_.cols(), heights_.rows());
    for (std::size_t level = 1; level < levels; ++level) {
        const glm::ivec2 middles = splits_in_middles(samples, level);
        const glm::ivec2 sides = splits_on_sides(samples, level);
        in_middles_[level] = Grid<StoredSplit>(middles.x, middles.y);
        on_sides_[level] = Grid<StoredSplit>(sides.x, sides.y);
    }
    cells_ = Grid<SplitBounds>(samples.x - 1, samples.y - 1);
    for_runs(cells_.rows(), samples_at_once, parallel,
             [&](int first, int last) { store_cell_rows(first, last); });
}

Bisection::Bisection(const Heightfield& heightfield, const Placement& placement,
                     const ParallelOptions& parallel)
    : Bisection(heightfield, placement, parallel, CellsOnly{}) {
    double done = 0.0;
    for (int size = 2; size <= tile_cells; size *= 2) {
        LevelBuilder(*this, size, true).build(*this, parallel);
        if (size < tile_cells) {
            LevelBuilder(*this, size, false).build(*this, parallel);
        }
        if (parallel.progress) {
            parallel.progress(++done / (levels - 1.0)); // all take about the same time
        }
    }
}

bool Bisection::is_valid(std::uint32_t seed, const ParallelOptions& parallel) const {
    bool valid = true;
    for (int size = 2; size <= tile_cells && valid; size *= 2) {
        valid = LevelBuilder(*this, size, true).is_valid(seed, parallel) &&
                (size == tile_cells || LevelBuilder(*this, size, false).is_valid(seed, parallel));
    }
    return valid;
}

// Squares are cut as far as a bound asks for. Floats from the eye hold 2^-24 of their length: of
// ground that is 2^20 samples high, finer triangles would have lost their shape.
int Bisection::min_size_for(const Heightfield& heightfield) const {
    constexpr double max_height = 0x1p20; // samples
    const double height = placement_->exaggeration() *
                          (static_cast<double>(heightfield.range.high) - heightfield.range.low);
    const double spacing = std::min(heightfield.spacing.x, heightfield.spacing.y);
    return height > max_height * spacing ? steps_per_sample / 64 : 2;
}

void Bisection::store_cell_rows(int first, int last) {
    const int low = std::max(first - 1, 0);
    const int high = std::min(last + 1, cells_.rows());
    Grid<CellBend> bends(cells_.cols(), high - low);
    for (int row = low; row < high; ++row) {
        for (int col = 0; col < cells_.cols(); ++col) {
            bends(col, row - low) = bend_of_cell(col, row);
        }
    }
    for (int row = first; row < last; ++row) {
        for (int col = 0; col < cells_.cols(); ++col) {
            CellBend bound = bends(col, row - low);
            for (int i = 0; i < 9; ++i) {
                const CellBend& near = bends.clamped(col + i % 3 - 1, row - low + i / 3 - 1);
                bound.side = std::max(bound.side, near.side);
                bound.reach = std::max(bound.reach, near.reach);
            }
            cells_(col, row) = {UpperBound(0.25 * std::max(bound.middle, bound.side)),
                                UpperBound(1.5 * bound.reach * sphere_growth + center_error())};
        }
    }
}

// Bilinear between the cell's corners. On an ellipsoid the error is below the curvature.
glm::dvec3 Bisection::position_in_cell(Steps place) const {
    const glm::ivec2 cell = sample_before(glm::min(place, end_ - std::int64_t{1}));
    const glm::dvec2 part = samples_of(place - steps_of(cell));
    const glm::dvec3 north =
        glm::mix(position(cell.x, cell.y), position(cell.x + 1, cell.y), part.x);
    const glm::dvec3 south =
        glm::mix(position(cell.x, cell.y + 1), position(cell.x + 1, cell.y + 1), part.x);
    return glm::mix(north, south, part.y);
}

Bisection::CellBend Bisection::bend_of_cell(int col, int row) const {
    const double h00 = heights_(col, row);
    const double h10 = heights_(col + 1, row);
    const double h01 = heights_(col, row + 1);
    const double h11 = heights_(col + 1, row + 1);
    const double exaggeration = placement_->exaggeration();
    const double twist = exaggeration * std::abs(h00 - h10 - h01 + h11);
    const double steepness = exaggeration * (std::max(std::abs(h10 - h00), std::abs(h11 - h01)) +
                                             std::max(std::abs(h01 - h00), std::abs(h11 - h10)));
    const double leaning = steepness * bending_.turn;
    return {twist + bending_.curvature + std::sqrt(2.0) * leaning,
            0.25 * twist + 0.5 * bending_.curvature + leaning,
            bending_.curvature == 0.0
                ? std::sqrt(bending_.stretch * bending_.stretch + steepness * steepness)
                : bending_.stretch + steepness};
}

Split Bisection::split_in_cell(Steps place, int size, bool on_side) const {
    if (size == steps_per_sample && !on_side) {
        const glm::ivec2 cell = sample_before(place);
        const SplitBounds& bounds = cells_(cell.x, cell.y);
        return {bounds.error.value(), position_in_cell(place), bounds.radius.value()};
    }
    const int reach = on_side ? size : 3 * size / 2;
    const glm::ivec2 own = sample_before(place);
    const glm::ivec2 first = glm::max(cell_at(place - std::int64_t{reach}), 0);
    const glm::ivec2 last =
        glm::min(cell_at(place + std::int64_t{reach - 1}), sample_before(end_) - 1);
    double bend = 0.0;
    double longest = 0.0;
    for (int row = first.y; row <= last.y; ++row) {
        for (int col = first.x; col <= last.x; ++col) {
            const CellBend cell = bend_of_cell(col, row);
            const bool is_own = !on_side && col == own.x && row == own.y;
            bend = std::max(bend, is_own ? std::max(cell.middle, cell.side) : cell.side);
            longest = std::max(longest, cell.reach);
        }
    }
    const double samples = static_cast<double>(size) / steps_per_sample;
    const double error = 0.25 * samples * samples * bend;
    const double radius = longest * reach / steps_per_sample * sphere_growth;
    return 2.0 * center_error() > bending_.stretch * samples
               ? Split{error, world(place), radius}
               : Split{error, position_in_cell(place), radius + center_error()};
}

double Bisection::height(Steps place) const {
    const glm::ivec2 sample = sample_before(place);
    return steps_of(sample) == place ? static_cast<double>(heights_(sample.x, sample.y))
                                     : bilinear_height(heights_, samples_of(place));
}

glm::dvec3 Bisection::world(Steps place) const {
    return placement_->world_from_sample({samples_of(place), height(place)});
}

glm::ivec2 Bisection::splits_in_middles(glm::ivec2 samples, std::size_t level) {
    return (samples - 1) / (1 << level) + 1;
}

glm::ivec2 Bisection::splits_on_sides(glm::ivec2 samples, std::size_t level) {
    const glm::ivec2 last = samples - 1;
    return {last.x / (1 << level) + 1, 2 * last.y / (1 << level) + 1};
}

std::size_t Bisection::bounds_count(glm::ivec2 samples) {
    std::size_t splits = 0;
    for (std::size_t level = 1; level < levels; ++level) {
        const glm::ivec2 middles = splits_in_middles(samples, level);
        const glm::ivec2 sides = splits_on_sides(samples, level);
        splits += static_cast<std::size_t>(middles.x) * static_cast<std::size_t>(middles.y) +
                  static_cast<std::size_t>(sides.x) * static_cast<std::size_t>(sides.y);
    }
    return splits;
}

template <class Self, class Visit> void Bisection::for_each_stored(Self& self, const Visit& visit) {
    for (std::size_t level = 1; level < levels; ++level) {
        const int half = 1 << (level - 1);
        auto& middles = self.in_middles_[level];
        for (int row = 0; row < middles.rows(); ++row) {
            for (int col = 0; col < middles.cols(); ++col) {
                visit(middles(col, row), half * glm::ivec2(2 * col + 1, 2 * row + 1));
            }
        }
        auto& sides = self.on_sides_[level];
        for (int row = 0; row < sides.rows(); ++row) {
            const int first = 1 - row % 2;
            for (int col = 0; col < sides.cols(); ++col) {
                visit(sides(col, row), half * glm::ivec2(2 * col + first, row));
            }
        }
    }
}

std::vector<SplitBounds> Bisection::bounds() const {
    std::vector<SplitBounds> bounds;
    bounds.reserve(bounds_count({heights_.cols(), heights_.rows()}));
    for_each_stored(*this,
                    [&](const StoredSplit& split, glm::ivec2) { bounds.push_back(split.bounds); });
    return bounds;
}

Bisection::Bisection(const Heightfield& heightfield, const Placement& placement,
                     std::span<const SplitBounds> bounds, const ParallelOptions& parallel)
    : Bisection(heightfield, placement, parallel, CellsOnly{}) {
    check(bounds.size() == bounds_count({heights_.cols(), heights_.rows()}),
          "the bounds of another bisection");
    auto next = bounds.begin();
    for_each_stored(*this, [&](StoredSplit& split, glm::ivec2 sample) {
        split.bounds = *next++;
        if (sample.x < heights_.cols() && sample.y < heights_.rows()) {
            split.height = heights_(sample.x, sample.y);
        }
    });
}

} // namespace reljef::terrain
