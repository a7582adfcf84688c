#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include "engine/geo/cubic.h"
#include "engine/geo/georeference.h"

namespace reljef::geo {
namespace {

constexpr int max_iterations = 40;
constexpr double converged_samples = 1e-9;

Grid<glm::dvec3> with_third(const Grid<glm::dvec2>& control) {
    Grid<glm::dvec3> result(control.cols(), control.rows());
    std::transform(control.samples().begin(), control.samples().end(), result.samples().begin(),
                   [](glm::dvec2 value) { return glm::dvec3(value, 0.0); });
    return result;
}

Error no_sample(double latitude, double longitude) {
    return {fmt::format("{},{}: lies outside what the raster's projection can show, a position on "
                        "or near the raster was expected",
                        latitude, longitude)};
}

// The value alone, computed as with derivatives: to the same bits.
glm::dvec3 value_at(const Grid<glm::dvec3>& control, glm::dvec2 position) {
    check(!control.empty(), "GeodeticMap without control points");
    const Cubic across = cubic_at(position.x, control.cols());
    const Cubic down = cubic_at(position.y, control.rows());
    glm::dvec3 value{0.0};
    for (std::size_t j = 0; j < 4; ++j) {
        glm::dvec3 at{0.0};
        for (std::size_t i = 0; i < 4; ++i) {
            at += across.weights[i] *
                  control(across.first + static_cast<int>(i), down.first + static_cast<int>(j));
        }
        value += down.weights[j] * at;
    }
    return value;
}

} // namespace

GeodeticMap::GeodeticMap(const Grid<glm::dvec2>& control, glm::dvec2 first, glm::dvec2 step)
    : GeodeticMap(with_third(control), first, step, Kind::degrees) {}

GeodeticMap::GeodeticMap(const Grid<glm::dvec3>& normals, glm::dvec2 first, glm::dvec2 step)
    : GeodeticMap(normals, first, step, Kind::normals) {}

GeodeticMap::GeodeticMap(Grid<glm::dvec3> control, glm::dvec2 first, glm::dvec2 step, Kind kind)
    : kind_(kind), control_(std::move(control)), first_(first), step_(step) {
    check(control_.cols() >= 4 && control_.rows() >= 4, "GeodeticMap needs 4×4 control points");
    check(step.x > 0.0 && step.y > 0.0, "GeodeticMap needs a step > 0");
    base_ = control_(control_.cols() / 2, control_.rows() / 2);
    for (glm::dvec3& value : control_.samples()) {
        value -= base_;
    }
    middle_longitude_ = latitude_longitude(middle()).y;
    if (kind_ == Kind::degrees) {
        find_linear_inverse();
    }
}

// Of control points on a plane, unless they are off by what Newton's method would notice.
void GeodeticMap::find_linear_inverse() {
    const glm::dvec2 last(control_.cols() - 1, control_.rows() - 1);
    const glm::dvec2 corner(control_(0, 0));
    const glm::dvec2 by_col = (glm::dvec2(control_(control_.cols() - 1, 0)) - corner) / last.x;
    const glm::dvec2 by_row = (glm::dvec2(control_(0, control_.rows() - 1)) - corner) / last.y;
    const double tolerance =
        converged_samples * std::min(glm::length(by_col) / step_.x, glm::length(by_row) / step_.y);
    for (int row = 0; row < control_.rows(); ++row) {
        for (int col = 0; col < control_.cols(); ++col) {
            const glm::dvec2 plane =
                corner + static_cast<double>(col) * by_col + static_cast<double>(row) * by_row;
            if (!(glm::distance(plane, glm::dvec2(control_(col, row))) <= tolerance)) {
                return;
            }
        }
    }
    const glm::dmat2 degrees(by_col, by_row);
    if (std::abs(glm::determinant(degrees)) > 0.0) {
        linear_inverse_ = glm::inverse(degrees);
    }
}

GeodeticMap::Value GeodeticMap::evaluate(glm::dvec2 sample) const {
    check(!control_.empty(), "GeodeticMap without control points");
    const glm::dvec2 position = (sample - first_) / step_;
    const Cubic across = cubic_at(position.x, control_.cols());
    const Cubic down = cubic_at(position.y, control_.rows());
    Value value;
    for (std::size_t j = 0; j < 4; ++j) {
        glm::dvec3 at{0.0};
        glm::dvec3 by_col{0.0};
        for (std::size_t i = 0; i < 4; ++i) {
            const glm::dvec3 control =
                control_(across.first + static_cast<int>(i), down.first + static_cast<int>(j));
            at += across.weights[i] * control;
            by_col += across.slopes[i] * control;
        }
        value.at += down.weights[j] * at;
        value.by_col += down.weights[j] * by_col;
        value.by_row += down.slopes[j] * at;
    }
    value.by_col /= step_.x;
    value.by_row /= step_.y;
    return value;
}

glm::dvec2 GeodeticMap::middle() const {
    return first_ + 0.5 * step_ * glm::dvec2(control_.cols() - 1, control_.rows() - 1);
}

GeodeticMap GeodeticMap::closed(const GlobalWrap& wrap, int cols, int rows) const {
    GeodeticMap map(*this);
    map.rows_ = WrappedRows(wrap, rows);
    if (wrap.east) {
        map.middle_longitude_ = latitude_longitude({0.5 * cols, 0.5 * (rows - 1)}).y;
    }
    return map;
}

std::optional<DegreeGrid> GeodeticMap::degree_grid() const {
    if (!linear_inverse_) {
        return std::nullopt;
    }
    const glm::dmat2 samples_a_step(step_.x, 0.0, 0.0, step_.y);
    const glm::dmat2 samples_a_degree = samples_a_step * *linear_inverse_;
    const glm::dvec2 first_sample = first_ + glm::dvec2(0.0, rows_.wrap().north_rows());
    return DegreeGrid{glm::dvec2(base_ + control_(0, 0)) -
                          glm::inverse(samples_a_degree) * first_sample,
                      samples_a_degree, middle_longitude_, rows_};
}

GeodeticMap GeodeticMap::resampled(glm::dvec2 factor) const {
    check(factor.x > 0.0 && factor.y > 0.0, "GeodeticMap::resampled needs factors > 0");
    GeodeticMap map(*this);
    map.first_ /= factor;
    map.step_ /= factor;
    return map;
}

double WrappedRows::source_row(double row) const {
    const double source = row - closing_.north_rows();
    if (closing_.north > 0.0 && source < 0.0) {
        return source * closing_.north;
    }
    if (closing_.south > 0.0 && source > last_) {
        return last_ + (source - last_) * closing_.south;
    }
    return source;
}

double WrappedRows::closed_row(double source_row) const {
    double source = source_row;
    if (closing_.north > 0.0 && source < 0.0) {
        source /= closing_.north;
    } else if (closing_.south > 0.0 && source > last_) {
        source = last_ + (source - last_) / closing_.south;
    }
    return source + closing_.north_rows();
}

glm::dvec2 GeodeticMap::latitude_longitude(glm::dvec2 sample) const {
    const glm::dvec2 source(sample.x, rows_.source_row(sample.y));
    const glm::dvec3 value = base_ + value_at(control_, (source - first_) / step_);
    if (kind_ == Kind::degrees) {
        return {std::clamp(value.x, -90.0, 90.0), value.y};
    }
    return {glm::degrees(std::atan2(value.z, std::hypot(value.x, value.y))),
            glm::degrees(std::atan2(value.y, value.x))};
}

bool GeodeticMap::is_past_pole(glm::dvec2 sample) const {
    constexpr double rounding = 1e-9; // degrees
    const glm::dvec2 source(sample.x, rows_.source_row(sample.y));
    const glm::dvec3 value = base_ + value_at(control_, (source - first_) / step_);
    return kind_ == Kind::degrees && std::abs(value.x) > 90.0 + rounding;
}

GeodeticMap::Target GeodeticMap::target(double latitude, double longitude) const {
    if (kind_ == Kind::degrees) {
        const double turns = std::round((longitude - middle_longitude_) / 360.0);
        const glm::dvec3 at(latitude - base_.x, longitude - 360.0 * turns - base_.y, 0.0);
        return {at, {glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(0.0, 1.0, 0.0)}};
    }
    const double lambda = glm::radians(longitude);
    const glm::dvec3 up = normal_from_geodetic(latitude, longitude);
    const glm::dvec3 east(-std::sin(lambda), std::cos(lambda), 0.0);
    return {up - base_, {east, glm::cross(up, east)}};
}

Result<glm::dvec2> GeodeticMap::sample(double latitude, double longitude) const {
    if (!(std::abs(latitude) <= 90.0) || !std::isfinite(longitude)) {
        return Error{
            fmt::format("{},{}: is no position, a latitude in [-90, 90] and a longitude in "
                        "degrees were expected",
                        latitude, longitude)};
    }
    const Target desired = target(latitude, longitude);
    if (linear_inverse_) {
        const glm::dvec2 degrees(desired.at - control_(0, 0));
        const glm::dvec2 found = first_ + step_ * (*linear_inverse_ * degrees);
        return glm::dvec2(found.x, rows_.closed_row(found.y));
    }
    const auto& [first, second] = desired.directions;
    glm::dvec2 sample = middle();
    for (int iteration = 0; iteration < max_iterations; ++iteration) {
        const Value value = evaluate(sample);
        const glm::dvec3 miss = desired.at - value.at;
        const glm::dmat2 jacobian(glm::dot(value.by_col, first), glm::dot(value.by_col, second),
                                  glm::dot(value.by_row, first), glm::dot(value.by_row, second));
        if (glm::determinant(jacobian) == 0.0) {
            break;
        }
        const glm::dvec2 step =
            glm::inverse(jacobian) * glm::dvec2(glm::dot(miss, first), glm::dot(miss, second));
        sample += step;
        if (!std::isfinite(sample.x + sample.y)) {
            break;
        }
        if (std::abs(step.x) <= converged_samples && std::abs(step.y) <= converged_samples) {
            const bool other_side =
                kind_ == Kind::normals && glm::dot(base_ + desired.at, base_ + value.at) <= 0.0;
            return other_side ? Result<glm::dvec2>(no_sample(latitude, longitude))
                              : glm::dvec2(sample.x, rows_.closed_row(sample.y));
        }
    }
    return no_sample(latitude, longitude);
}

} // namespace reljef::geo
