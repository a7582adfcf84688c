#include "engine/terrain/gradient.h"

#include <algorithm>

#include <glm/geometric.hpp>

#include "engine/core/worker_pool.h"

namespace reljef::terrain {
namespace {

// East, north and up at a place of the heightfield, in the scene frame.
struct Axes {
    glm::dvec3 east{1.0, 0.0, 0.0};
    glm::dvec3 north{0.0, 1.0, 0.0};
    glm::dvec3 up{0.0, 0.0, 1.0};
};

// Rise over run along the columns (east) and against the rows (north), from neighbours that exist.
glm::dvec2 local_slope(const Grid<float>& heights, glm::dvec2 spacing, int col, int row) {
    const int west = std::max(col - 1, 0);
    const int east = std::min(col + 1, heights.cols() - 1);
    const int north = std::max(row - 1, 0);
    const int south = std::min(row + 1, heights.rows() - 1);
    const auto height = [&](int c, int r) { return static_cast<double>(heights(c, r)); };
    return {(height(east, row) - height(west, row)) / ((east - west) * spacing.x),
            (height(col, north) - height(col, south)) / ((south - north) * spacing.y)};
}

Axes axes_at(const Placement& placement, glm::dvec2 sample) {
    const auto place = [&](double col, double row) {
        return placement.world_from_sample({col, row, 0.0});
    };
    Axes axes;
    axes.up = placement.up(place(sample.x, sample.y));
    axes.east = glm::normalize(place(sample.x + 0.5, sample.y) - place(sample.x - 0.5, sample.y));
    axes.north = glm::normalize(place(sample.x, sample.y - 0.5) - place(sample.x, sample.y + 0.5));
    return axes;
}

Axes between(const Axes& a, const Axes& b, double t) {
    return {a.east + t * (b.east - a.east), a.north + t * (b.north - a.north),
            a.up + t * (b.up - a.up)};
}

// The ground axes at every `step`-th sample; they turn so slowly that between them linear is enough.
class AxesGrid {
public:
    AxesGrid(const Placement& placement, int cols, int rows)
        : axes_((cols - 1) / step + 2, (rows - 1) / step + 2) {
        for (int row = 0; row < axes_.rows(); ++row) {
            for (int col = 0; col < axes_.cols(); ++col) {
                axes_(col, row) = axes_at(placement, {col * step, row * step});
            }
        }
    }

    [[nodiscard]] Axes at(int col, int row) const {
        const int c = col / step;
        const int r = row / step;
        const double u = static_cast<double>(col % step) / step;
        const double v = static_cast<double>(row % step) / step;
        return between(between(axes_(c, r), axes_(c + 1, r), u),
                       between(axes_(c, r + 1), axes_(c + 1, r + 1), u), v);
    }

private:
    static constexpr int step = 32;
    Grid<Axes> axes_;
};

glm::vec2 scene_slope(const Axes& axes, glm::dvec2 slope) {
    const glm::dvec3 normal = axes.up - slope.x * axes.east - slope.y * axes.north;
    return glm::vec2(glm::dvec2(-normal.x, -normal.y) / normal.z);
}

} // namespace

Grid<glm::vec2> scene_gradients(const Heightfield& heightfield, const Placement& placement) {
    const Grid<float>& heights = heightfield.heights;
    Grid<glm::vec2> gradients(heights.cols(), heights.rows());
    std::optional<AxesGrid> axes;
    if (placement.kind() == PlacementKind::ellipsoid) {
        axes.emplace(placement, heights.cols(), heights.rows());
    }
    parallel_for(heights.rows(), [&](int row) {
        for (int col = 0; col < heights.cols(); ++col) {
            const glm::dvec2 slope = placement.exaggeration() *
                                     local_slope(heights, heightfield.spacing, col, row);
            gradients(col, row) = axes ? scene_slope(axes->at(col, row), slope) : glm::vec2(slope);
        }
    });
    return gradients;
}

} // namespace reljef::terrain
