#include "engine/io/raster/geodetic_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <glm/geometric.hpp>

namespace reljef::io {
namespace {

/// Bounds of a grid's outline; absent if it spans half the globe or more.
std::optional<DegreeBox> bounds_of(const ExactTransform& rough, const SampleGrid& grid) {
    constexpr int points = 21;
    std::vector<glm::dvec2> outline;
    for (int i = 0; i < points; ++i) {
        const double t = static_cast<double>(i) / (points - 1);
        const glm::dvec2 last(grid.cols - 1, grid.rows - 1);
        outline.insert(outline.end(), {glm::dvec2(t, 0.0) * last, glm::dvec2(t, 1.0) * last,
                                       glm::dvec2(0.0, t) * last, glm::dvec2(1.0, t) * last});
    }
    if (!rough.positions(grid, outline)) {
        return std::nullopt;
    }
    const auto by_latitude = [](glm::dvec2 a, glm::dvec2 b) { return a.x < b.x; };
    const auto by_longitude = [](glm::dvec2 a, glm::dvec2 b) { return a.y < b.y; };
    const auto [south, north] = std::minmax_element(outline.begin(), outline.end(), by_latitude);
    const auto [west, east] = std::minmax_element(outline.begin(), outline.end(), by_longitude);
    const bool is_local = east->y - west->y < 180.0 && west->y >= -180.0 && east->y <= 180.0;
    return is_local ? std::optional(DegreeBox{west->y, south->x, east->y, north->x}) : std::nullopt;
}

constexpr std::array controls_a_side{9, 17, 33, 65, 129, 257};
constexpr double earth_radius = 6378137.0;

/// Exact positions at control points and at the centres of their cells.
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

std::optional<Exact> exact_positions(const ExactTransform& exact, const SampleGrid& grid,
                                     int side) {
    Exact result;
    result.step = glm::dvec2(grid.cols - 1, grid.rows - 1) / static_cast<double>(side - 1);
    result.controls = lattice(side, glm::dvec2(0.0), result.step);
    result.centers = lattice(side - 1, 0.5 * result.step, result.step);
    const bool known = exact.positions(grid, result.controls.samples()) &&
                       exact.positions(grid, result.centers.samples());
    return known ? std::optional(std::move(result)) : std::nullopt;
}

/// Makes longitudes continuous from one control point to the next.
Grid<glm::dvec2> unwrapped(Grid<glm::dvec2> controls) {
    for (int row = 0; row < controls.rows(); ++row) {
        for (int col = 0; col < controls.cols(); ++col) {
            const glm::dvec2 neighbour =
                col > 0 ? controls(col - 1, row) : controls(col, std::max(row - 1, 0));
            double& longitude = controls(col, row).y;
            longitude += 360.0 * std::round((neighbour.y - longitude) / 360.0);
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

glm::dvec2 crs_from_sample(const geo::PixelAffine& affine, const SampleGrid& grid,
                           glm::dvec2 sample) {
    return affine.crs_from_pixel(grid.pixel_from_sample(sample));
}

std::optional<ExactTransform> ExactTransform::create(const OGRSpatialReference& crs,
                                                     const geo::PixelAffine& affine,
                                                     const SampleGrid& grid) {
    const OGRSpatialReference wgs84 = crs_from_text(wgs84_degrees);
    auto rough = CrsTransform::create(crs, wgs84);
    if (!rough) {
        return std::nullopt;
    }
    ExactTransform result(std::move(*rough), affine);
    if (const auto bounds = bounds_of(result, grid)) {
        if (auto best = CrsTransform::create(crs, wgs84, bounds)) {
            result.transform_ = std::move(*best);
        }
    }
    return result;
}

bool ExactTransform::positions(const SampleGrid& grid, std::span<glm::dvec2> samples) const {
    for (glm::dvec2& sample : samples) {
        sample = crs_from_sample(affine_, grid, sample);
    }
    transform_.apply(samples);
    for (glm::dvec2& sample : samples) {
        sample = {sample.y, sample.x};
    }
    return std::all_of(samples.begin(), samples.end(), [](glm::dvec2 position) {
        return std::abs(position.x) <= 90.0 + 1e-9; // false for NaN
    });
}

std::optional<GeodeticFit> fit_geodetic_map(const ExactTransform& exact, const SampleGrid& grid) {
    std::optional<GeodeticFit> best;
    for (const int side : controls_a_side) {
        const auto positions = exact_positions(exact, grid, side);
        if (!positions) {
            return std::nullopt;
        }
        const glm::dvec2 first(0.0);
        const std::array maps{
            geo::GeodeticMap(unwrapped(positions->controls), first, positions->step),
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
