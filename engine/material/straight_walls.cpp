#include "engine/material/straight_walls.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace reljef::material {
namespace {

constexpr int reach = 4;        // samples
constexpr double spread = 1.75; // of the weights, samples
constexpr double pi = 3.14159265358979323846;

// Weights along a row, or along a column.
std::array<double, reach + 1> normal_weights() {
    std::array<double, reach + 1> weights{};
    for (int i = 0; i <= reach; ++i) {
        weights.at(static_cast<std::size_t>(i)) = std::exp(-0.5 * i * i / (spread * spread));
    }
    return weights;
}

struct Sides {
    float low = 0.0F; // means of the samples around, metres
    float high = 0.0F;
    float middle = 0.0F; // between the lowest and the highest
    bool has_wall = false;
};

class WallFilter {
public:
    WallFilter(GridView<const float> heights, const Grid<std::uint8_t>& void_mask, double min_rise)
        : heights_(heights), void_mask_(void_mask), min_rise_(min_rise) {}

    [[nodiscard]] float height_at(int col, int row) const {
        const float own = heights_(col, row);
        const Sides sides = sides_of(col, row);
        if (!sides.has_wall) {
            return own;
        }
        const double inside = distance_inside(col, row, sides.middle);
        const bool is_high = own > sides.middle;
        const bool is_thin = is_high ? inside <= -0.5 : inside >= 0.5; // a post, or a shaft
        const bool is_off_wall = is_high ? inside >= 0.5 : inside <= -0.5;
        if (is_thin || is_off_wall) {
            return own;
        }
        // A sample on the higher side is not outside, whatever the samples around it are.
        const double known = is_high ? std::max(inside, 0.0) : std::min(inside, 0.0);
        const auto share = static_cast<float>(known + 0.5);
        return sides.low + share * (sides.high - sides.low);
    }

private:
    [[nodiscard]] bool is_void(int col, int row) const {
        return !void_mask_.empty() && void_mask_(col, row) != 0;
    }

    // Calls `body` for the samples up to `away` samples from one. False beside a void or the
    // border.
    template <class Body>
    [[nodiscard]] bool for_each_around(int col, int row, int away, const Body& body) const {
        if (col < away || row < away || col + away >= heights_.cols() ||
            row + away >= heights_.rows()) {
            return false;
        }
        for (int y = -away; y <= away; ++y) {
            for (int x = -away; x <= away; ++x) {
                if (is_void(col + x, row + y)) {
                    return false;
                }
                body(x, y, heights_(col + x, row + y));
            }
        }
        return true;
    }

    [[nodiscard]] Sides sides_of(int col, int row) const {
        float lowest = heights_(col, row);
        float highest = lowest;
        const bool is_whole = for_each_around(col, row, 1, [&](int, int, float height) {
            lowest = std::min(lowest, height);
            highest = std::max(highest, height);
        });
        Sides sides;
        sides.has_wall = is_whole && highest - lowest >= min_rise_;
        if (!sides.has_wall) {
            return sides;
        }
        sides.middle = 0.5F * (lowest + highest);
        std::array<float, 2> sums{};
        std::array<float, 2> counts{};
        const float quarter = 0.25F * (highest - lowest);
        bool is_between = false; // walls have samples that are not: they are straight already
        sides.has_wall = for_each_around(col, row, 1, [&](int, int, float height) {
            const std::size_t side = height > sides.middle ? 1 : 0;
            sums.at(side) += height;
            counts.at(side) += 1.0F;
            is_between = is_between || std::abs(height - sides.middle) < quarter;
        });
        const bool has_sides = counts[0] > 0.0F && counts[1] > 0.0F; // despite rounding
        sides.has_wall = sides.has_wall && !is_between && has_sides;
        if (sides.has_wall) {
            sides.low = sums[0] / counts[0];
            sides.high = sums[1] / counts[1];
        }
        return sides;
    }

    // Samples from the wall into the higher side: of a straight wall, the share of the samples
    // above the middle height rises by 1 / (spread √2π) per sample.
    [[nodiscard]] double distance_inside(int col, int row, float middle) const {
        double high = 0.0;
        double all = 0.0;
        const bool is_whole = for_each_around(col, row, reach, [&](int x, int y, float height) {
            const double weight = weights_.at(static_cast<std::size_t>(std::abs(x))) *
                                  weights_.at(static_cast<std::size_t>(std::abs(y)));
            high += height > middle ? weight : 0.0;
            all += weight;
        });
        if (!is_whole) {
            return heights_(col, row) > middle ? 1.0 : -1.0;
        }
        return (high / all - 0.5) * spread * std::sqrt(2.0 * pi);
    }

    GridView<const float> heights_;
    const Grid<std::uint8_t>& void_mask_;
    double min_rise_;
    std::array<double, reach + 1> weights_ = normal_weights();
};

} // namespace

StraightWalls straight_walls(GridView<const float> heights, const Grid<std::uint8_t>& void_mask,
                             double min_rise, const ParallelOptions& parallel) {
    const WallFilter filter(heights, void_mask, min_rise);
    StraightWalls made{Grid<float>(heights.cols(), heights.rows())};
    std::vector<StraightWalls> rows(static_cast<std::size_t>(heights.rows()));
    const auto filter_row = [&](int row) {
        StraightWalls& sum = rows[static_cast<std::size_t>(row)];
        for (int col = 0; col < heights.cols(); ++col) {
            made.heights(col, row) = filter.height_at(col, row);
            const double change = std::abs(made.heights(col, row) - heights(col, row));
            sum.changed += change > 0.0 ? 1U : 0U;
            sum.largest = std::max(sum.largest, change);
        }
    };
    const bool is_whole = parallel_for(heights.rows(), filter_row, parallel);
    for (const StraightWalls& row : rows) {
        made.changed += row.changed;
        made.largest = std::max(made.largest, row.largest);
    }
    return is_whole ? std::move(made) : StraightWalls{};
}

} // namespace reljef::material
