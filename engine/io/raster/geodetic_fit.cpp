#include "engine/io/raster/geodetic_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace reljef::io {
namespace {

constexpr std::array controls_a_side{9, 17, 33, 65, 129, 257};
constexpr double earth_radius = 6378137.0;

/// Exact positions at control points and at the centres between them.
struct Exact {
    Grid<glm::dvec2> controls;
    Grid<glm::dvec2> centers;
    glm::dvec2 step{1.0};
};

Grid<glm::dvec2> lattice(int side, glm::dvec2 first, glm::dvec2 step) {
    Grid<glm::dvec2> points(side, side);
    for (int row = 0; row < side; ++row) {
        for (int col = 0; col < side; ++col) {
            points(col, row) = first + step * glm::dvec2(col, row);
        }
    }
    return points;
}

std::optional<Exact> exact_positions(const ExactPositions& exact, int side, glm::dvec2 size) {
    Exact result;
    result.step = size / static_cast<double>(side - 1);
    result.controls = lattice(side, glm::dvec2(0.0), result.step);
    result.centers = lattice(side - 1, 0.5 * result.step, result.step);
    if (!exact(result.controls.samples()) || !exact(result.centers.samples())) {
        return std::nullopt;
    }
    return result;
}

double run_on(double longitude, double neighbour) {
    return longitude + 360.0 * std::round((neighbour - longitude) / 360.0);
}

/// Longitudes without a jump of 360 from one control point to the next.
Grid<glm::dvec2> without_jumps(Grid<glm::dvec2> controls) {
    for (int row = 0; row < controls.rows(); ++row) {
        for (int col = 0; col < controls.cols(); ++col) {
            if (col > 0) {
                controls(col, row).y = run_on(controls(col, row).y, controls(col - 1, row).y);
            } else if (row > 0) {
                controls(col, row).y = run_on(controls(col, row).y, controls(col, row - 1).y);
            }
        }
    }
    return controls;
}

Grid<glm::dvec3> normals_of(const Grid<glm::dvec2>& positions) {
    Grid<glm::dvec3> normals(positions.cols(), positions.rows());
    std::transform(
        positions.samples().begin(), positions.samples().end(), normals.samples().begin(),
        [](glm::dvec2 position) { return geo::normal_from_geodetic(position.x, position.y); });
    return normals;
}

double largest_error(const geo::GeodeticMap& map, const Exact& exact) {
    double largest = 0.0;
    for (int row = 0; row < exact.centers.rows(); ++row) {
        for (int col = 0; col < exact.centers.cols(); ++col) {
            const glm::dvec2 desired = exact.centers(col, row);
            const glm::dvec2 found =
                map.latitude_longitude(exact.step * (glm::dvec2(col, row) + 0.5));
            const double error =
                earth_radius * glm::distance(geo::normal_from_geodetic(desired.x, desired.y),
                                             geo::normal_from_geodetic(found.x, found.y));
            largest = std::isfinite(error) ? std::max(largest, error)
                                           : std::numeric_limits<double>::infinity();
        }
    }
    return largest;
}

} // namespace

std::optional<GeodeticFit> fit_geodetic_map(const ExactPositions& exact, int cols, int rows) {
    const glm::dvec2 size(cols - 1, rows - 1);
    std::optional<GeodeticFit> best;
    for (const int side : controls_a_side) {
        const auto positions = exact_positions(exact, side, size);
        if (!positions) {
            return std::nullopt;
        }
        const glm::dvec2 first(0.0);
        const std::array maps{
            geo::GeodeticMap(without_jumps(positions->controls), first, positions->step),
            geo::GeodeticMap(normals_of(positions->controls), first, positions->step)};
        for (const geo::GeodeticMap& map : maps) {
            const double error = largest_error(map, *positions);
            if (!best || error < best->error) {
                best = GeodeticFit{map, error};
            }
            if (error <= map_tolerance) {
                return best;
            }
        }
    }
    return best;
}

} // namespace reljef::io
