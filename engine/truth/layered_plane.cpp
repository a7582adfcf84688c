#include "engine/truth/layered_plane.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

namespace reljef::truth {
namespace {

constexpr double no_end = std::numeric_limits<double>::infinity();

bool is_usable(const glm::vec4& heights) {
    bool usable = heights.x <= 1.0F && heights.w >= 0.0F;
    for (int i = 1; i < 4; ++i) {
        usable = usable && heights[i] <= heights[i - 1];
    }
    return usable;
}

Result<void> check_layers(GridView<const glm::vec4> layers) {
    if (layers.empty()) {
        return Error{"layers: there are no texels, at least one was expected"};
    }
    for (int row = 0; row < layers.rows(); ++row) {
        for (int col = 0; col < layers.cols(); ++col) {
            const glm::vec4& heights = layers(col, row);
            if (!is_usable(heights)) {
                return Error{fmt::format("layers: {}, {}, {}, {} found at column {}, row {}, "
                                         "falling heights in [0, 1] were expected",
                                         heights.x, heights.y, heights.z, heights.w, col, row)};
            }
        }
    }
    return {};
}

// The ray's height above a layer in one cell, c + b·t + a·t².
struct Clearance {
    double a = 0.0;
    double b = 0.0;
    double c = 0.0;
    [[nodiscard]] double at(double t) const { return c + t * (b + t * a); }
};

// The four corners of a cell: north-west, north-east, south-west, south-east.
using Corners = std::array<glm::dvec4, 4>;

Clearance clearance_of(const Corners& corners, int layer, const Ray& ray) {
    const double base = corners[0][layer];
    const double east = corners[1][layer] - base;
    const double south = corners[2][layer] - base;
    const double twist = corners[3][layer] - corners[1][layer] - corners[2][layer] + base;
    const glm::dvec3& o = ray.origin;
    const glm::dvec3& d = ray.direction;
    return {-twist * d.x * d.y, d.z - east * d.x - south * d.y - twist * (o.x * d.y + o.y * d.x),
            o.z - base - east * o.x - south * o.y - twist * o.x * o.y};
}

void add_roots(const Clearance& clearance, Interval within, std::vector<double>& times) {
    const auto add = [&](double t) {
        if (t > within.begin && t < within.end) {
            times.push_back(t);
        }
    };
    if (clearance.a == 0.0) {
        add(-clearance.c / clearance.b); // NaN: no root
        return;
    }
    const double discriminant = clearance.b * clearance.b - 4.0 * clearance.a * clearance.c;
    if (discriminant >= 0.0) {
        const double q = -0.5 * (clearance.b + std::copysign(std::sqrt(discriminant), clearance.b));
        add(q / clearance.a);
        add(clearance.c / q);
    }
}

class LayerWalk {
public:
    LayerWalk(const Grid<glm::vec4>& layers, bool wraps, const Ray& ray)
        : layers_(layers), wraps_(wraps), ray_(ray) {}

    struct Entry {
        double t = 0.0;
        int layer = 0;
    };
    std::optional<Entry> first_entry(Interval range) {
        return first_in_squares(
            ray_, glm::dvec2(1.0), range, LayeredPlane::max_cells,
            [&](glm::dvec2 cell, Interval within) { return entry_in(cell, within); });
    }

private:
    [[nodiscard]] int index_of(double index, int count) const {
        if (wraps_) {
            return static_cast<int>(index - count * std::floor(index / count));
        }
        return static_cast<int>(std::clamp(index, 0.0, count - 1.0));
    }

    [[nodiscard]] Corners corners_of(glm::dvec2 cell) const {
        Corners corners;
        for (std::size_t i = 0; i < 4; ++i) {
            const double col = cell.x + static_cast<double>(i % 2);
            const double row = cell.y + (i < 2 ? 0.0 : 1.0);
            corners[i] = layers_(index_of(col, layers_.cols()), index_of(row, layers_.rows()));
        }
        return corners;
    }

    // Between neighbouring crossings the ray is in the solid of the interval's middle.
    std::optional<Entry> entry_in(glm::dvec2 cell, Interval within) {
        Ray moved = ray_;
        moved.origin -= glm::dvec3(cell, 0.0);
        const Corners corners = corners_of(cell);
        std::array<Clearance, 4> clearances;
        std::vector<double> times{within.begin, within.end};
        for (int layer = 0; layer < 4; ++layer) {
            clearances[static_cast<std::size_t>(layer)] = clearance_of(corners, layer, moved);
            add_roots(clearances[static_cast<std::size_t>(layer)], within, times);
        }
        std::sort(times.begin(), times.end());
        for (std::size_t i = 0; i + 1 < times.size(); ++i) {
            const int solid = solid_at(clearances, 0.5 * (times[i] + times[i + 1]));
            if (times[i] < times[i + 1] && solid >= 0 && was_outside_) {
                return Entry{times[i], nearer_layer(clearances, solid, times[i])};
            }
            was_outside_ = times[i] < times[i + 1] ? solid < 0 : was_outside_;
        }
        return std::nullopt;
    }

    // The solid at a time, 0 or 1; -1: none.
    static int solid_at(const std::array<Clearance, 4>& clearances, double t) {
        for (std::size_t solid = 0; solid < 2; ++solid) {
            if (clearances[2 * solid].at(t) < 0.0 && clearances[2 * solid + 1].at(t) > 0.0) {
                return static_cast<int>(solid);
            }
        }
        return -1;
    }

    static int nearer_layer(const std::array<Clearance, 4>& clearances, int solid, double t) {
        const std::size_t top = 2U * static_cast<std::size_t>(solid);
        const bool is_top = std::abs(clearances[top].at(t)) <= std::abs(clearances[top + 1].at(t));
        return 2 * solid + (is_top ? 0 : 1);
    }

    const Grid<glm::vec4>& layers_;
    bool wraps_;
    Ray ray_;
    bool was_outside_ = false; // a ray may start inside
};

} // namespace

Result<LayeredPlane> LayeredPlane::create(GridView<const glm::vec4> layers,
                                          const ReliefOptions& options) {
    if (const auto good = check_layers(layers); !good) {
        return good.error();
    }
    if (const auto good = check_options(options); !good) {
        return good.error();
    }
    LayeredPlane plane;
    plane.options_ = options;
    plane.layers_ = Grid<glm::vec4>(layers.cols(), layers.rows());
    for (int row = 0; row < layers.rows(); ++row) {
        std::ranges::copy(layers.row(row), plane.layers_.row(row).begin());
    }
    return plane;
}

std::optional<ReliefHit> LayeredPlane::first_hit(const Ray& ray, Interval range) const {
    const glm::ivec2 texels(layers_.cols(), layers_.rows());
    const Ray on_tile = tile_ray(ray, texels, options_);
    if (!is_finite(on_tile)) {
        return std::nullopt;
    }
    constexpr double margin = 0.01; // rays begin outside the outermost faces
    Box reach{{-no_end, -no_end, -margin}, {no_end, no_end, 1.0 + margin}};
    if (options_.border == Border::discard) {
        reach.low = {-0.5, -0.5, -margin};
        reach.high = {texels.x - 0.5, texels.y - 0.5, 1.0 + margin};
    }
    const auto inside = intersect(on_tile, reach, range);
    if (!inside) {
        return std::nullopt;
    }
    LayerWalk walk(layers_, options_.border == Border::wrap, on_tile);
    const auto entry = walk.first_entry(*inside);
    if (!entry) {
        return std::nullopt;
    }
    ReliefHit hit = hit_at(on_tile, entry->t, texels, options_.border);
    hit.layer = entry->layer;
    return hit;
}

} // namespace reljef::truth
