#include "engine/terrain/field/gradient.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/core/parallel_for.h"

namespace reljef::terrain {
namespace {

// Local axes of the sample grid in the scene frame: the vectors to the next sample along the
// columns (east) and against the rows (north), metres, and the unit vector up.
struct Axes {
    glm::dvec3 east{1.0, 0.0, 0.0};
    glm::dvec3 north{0.0, 1.0, 0.0};
    glm::dvec3 up{0.0, 0.0, 1.0};
};

class Border {
public:
    explicit Border(const Heightfield& heightfield)
        : last_(heightfield.heights.cols() - 1, heightfield.heights.rows() - 1) {
        if (heightfield.georeference) {
            rows_ = heightfield.georeference->geodetic.rows();
        }
    }

    [[nodiscard]] bool is_pole(int row) const {
        return row < wrap().north_rows() || row > last_.y - wrap().south_rows();
    }
    // Limits of the places that differences may use.
    [[nodiscard]] glm::dvec2 low() const {
        return {wrap().around ? -1.0 : 0.0, wrap().north_rows()};
    }
    [[nodiscard]] glm::dvec2 high() const {
        return {last_.x + (wrap().around ? 1 : 0), last_.y - wrap().south_rows()};
    }

    // Rise per sample along the columns (east) and against the rows (north), metres.
    [[nodiscard]] glm::dvec2 rise(const Grid<float>& heights, int col, int row) const {
        const bool around = wrap().around;
        const int west = col > 0 ? col - 1 : around ? last_.x - 1 : 0;
        const int east = col < last_.x ? col + 1 : around ? 1 : last_.x;
        const int north = std::max(row - 1, 0);
        const int south = std::min(row + 1, last_.y);
        const auto height = [&](int c, int r) { return static_cast<double>(heights(c, r)); };
        return {(height(east, row) - height(west, row)) / (around ? 2 : east - west),
                (height(col, north) - height(col, south)) /
                    (rows_.source_row(south) - rows_.source_row(north))};
    }

private:
    [[nodiscard]] const geo::GlobalWrap& wrap() const { return rows_.wrap(); }
    glm::ivec2 last_;
    geo::WrappedRows rows_;
};

// Differences over a sample, or half a sample at the border: the map may end there.
Axes axes_at(const Placement& placement, glm::dvec2 sample, const Border& border) {
    const auto place = [&](double col, double row) {
        return placement.world_from_sample({col, row, 0.0});
    };
    const glm::dvec2 inside = glm::clamp(sample, border.low(), border.high());
    const glm::dvec2 from = glm::max(inside - 0.5, border.low());
    const glm::dvec2 to = glm::min(inside + 0.5, border.high());
    Axes axes;
    axes.up = placement.up(place(sample.x, sample.y));
    axes.east = (place(to.x, inside.y) - place(from.x, inside.y)) / (to.x - from.x);
    axes.north = (place(inside.x, from.y) - place(inside.x, to.y)) / (to.y - from.y);
    return axes;
}

Axes between(const Axes& a, const Axes& b, double t) {
    return {a.east + t * (b.east - a.east), a.north + t * (b.north - a.north),
            a.up + t * (b.up - a.up)};
}

// The axes at most 32 samples apart, linear in between.
class AxesGrid {
public:
    AxesGrid(const Placement& placement, int cols, int rows, const Border& border)
        : axes_((cols - 2) / widest_step + 2, (rows - 2) / widest_step + 2),
          step_(glm::dvec2(cols - 1, rows - 1) / glm::dvec2(axes_.cols() - 1, axes_.rows() - 1)) {
        for (int row = 0; row < axes_.rows(); ++row) {
            for (int col = 0; col < axes_.cols(); ++col) {
                axes_(col, row) = axes_at(placement, glm::dvec2(col, row) * step_, border);
            }
        }
    }

    // Along one row of samples.
    class Row {
    public:
        Row(std::vector<Axes> axes, double step) : axes_(std::move(axes)), step_(step) {}

        [[nodiscard]] Axes at(int col) const {
            const double place = col / step_;
            const auto c = std::min(static_cast<std::size_t>(place), axes_.size() - 2);
            return between(axes_[c], axes_[c + 1], place - static_cast<double>(c));
        }

    private:
        std::vector<Axes> axes_;
        double step_;
    };

    [[nodiscard]] Row row(int row) const {
        const double place = row / step_.y;
        const int r = std::min(static_cast<int>(place), axes_.rows() - 2);
        std::vector<Axes> axes;
        axes.reserve(static_cast<std::size_t>(axes_.cols()));
        for (int col = 0; col < axes_.cols(); ++col) {
            axes.push_back(between(axes_(col, r), axes_(col, r + 1), place - r));
        }
        return {std::move(axes), step_.x};
    }

private:
    static constexpr int widest_step = 32;
    Grid<Axes> axes_;
    glm::dvec2 step_;
};

// Smallest z of a normal. Ground beyond the horizon of a whole Earth overhangs.
constexpr double min_upright = 1e-6;
// Length of the east axis over that of the north axis; smaller ratios are at a pole.
constexpr double min_east = 1e-6;

// Of a normal of any length > 0.
glm::vec2 slope_of(glm::dvec3 normal) {
    const double steep = std::abs(normal.x) + std::abs(normal.y);
    const bool is_usual = normal.z > steep * min_upright; // so is the unit normal's z
    const double z = is_usual ? normal.z : std::max(normal.z, min_upright * glm::length(normal));
    return glm::vec2(glm::dvec2(-normal.x, -normal.y) / z);
}

glm::vec2 scene_slope(const Axes& axes, glm::dvec2 rise_per_sample) {
    if (glm::dot(axes.east, axes.east) <= min_east * min_east * glm::dot(axes.north, axes.north)) {
        return slope_of(axes.up);
    }
    const glm::dvec3 normal = glm::cross(axes.east + rise_per_sample.x * axes.up,
                                         axes.north + rise_per_sample.y * axes.up);
    return slope_of(normal == glm::dvec3(0.0) ? axes.up : normal);
}

} // namespace

Grid<glm::vec2> surface_gradients(const Heightfield& heightfield, const Placement& placement) {
    const Grid<float>& heights = heightfield.heights;
    check(heights.cols() >= 2 && heights.rows() >= 2, "gradients need at least 2x2 samples");
    Grid<glm::vec2> gradients(heights.cols(), heights.rows());
    const Border border(heightfield);
    std::optional<AxesGrid> axes;
    if (placement.kind() == PlacementKind::ellipsoid) {
        axes.emplace(placement, heights.cols(), heights.rows(), border);
    }
    parallel_for(heights.rows(), [&](int row) {
        std::optional<AxesGrid::Row> along;
        if (axes) {
            along = axes->row(row);
        }
        const bool is_pole = border.is_pole(row);
        for (int col = 0; col < heights.cols(); ++col) {
            const glm::dvec2 slope = placement.exaggeration() * border.rise(heights, col, row);
            gradients(col, row) = !along    ? glm::vec2(slope / heightfield.spacing)
                                  : is_pole ? slope_of(along->at(col).up)
                                            : scene_slope(along->at(col), slope);
        }
    });
    return gradients;
}

glm::dmat3 grid_axes(const Heightfield& heightfield, const Placement& placement,
                     glm::dvec2 sample) {
    const Axes axes = axes_at(placement, sample, Border(heightfield));
    return {glm::normalize(axes.east), glm::normalize(axes.north), glm::normalize(axes.up)};
}

glm::dvec3 metres_at(const Placement& placement, glm::dvec3 sample) {
    const glm::dvec3 here = placement.world_from_sample(sample);
    glm::dvec3 metres(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 beside = sample;
        beside[axis] += 1.0;
        metres[axis] = glm::distance(placement.world_from_sample(beside), here);
    }
    return metres;
}

double plane_distortion(const Heightfield& heightfield) {
    if (!heightfield.georeference) {
        return 0.0;
    }
    const auto placement = Placement::create(heightfield, PlacementKind::ellipsoid);
    if (!placement) {
        return 0.0;
    }
    const Border border(heightfield);
    const glm::dvec2 last(heightfield.heights.cols() - 1, heightfield.heights.rows() - 1);
    constexpr int steps = 8;
    double distortion = 0.0;
    for (int row = 0; row <= steps; ++row) {
        for (int col = 0; col <= steps; ++col) {
            const glm::dvec2 part = glm::dvec2(col, row) / static_cast<double>(steps);
            const Axes axes = axes_at(*placement, last * part, border);
            const glm::dvec2 metres(glm::length(axes.east), glm::length(axes.north));
            const glm::dvec2 wrong = glm::abs(metres / heightfield.spacing - 1.0);
            distortion = std::max({distortion, wrong.x, wrong.y, 1.0 - axes.up.z});
        }
    }
    return distortion;
}

} // namespace reljef::terrain
