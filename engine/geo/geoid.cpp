#include "engine/geo/geoid.h"

#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include <GeographicLib/Geoid.hpp>
#include <fmt/format.h>

#include "engine/core/check.h"
#include "engine/geo/cubic.h"

namespace reljef::geo {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
// Control points: rounding error of steps such as 1/60 over 360 degrees.
constexpr double rounding = 1e-6;

class UndulationGrid {
public:
    UndulationGrid(Grid<float> undulation, glm::dvec2 first, glm::dvec2 step)
        : undulation_(std::move(undulation)), first_(first), step_(step) {
        const double turn = std::abs(360.0 / step.y);
        around_ = undulation_.cols() >= turn - rounding
                      ? clamped_int(std::round(turn), 0, undulation_.cols())
                      : 0;
    }

    [[nodiscard]] double at(double latitude, double longitude) const {
        const double down = (latitude - first_.x) / step_.x;
        const double across = column_of(longitude);
        const double last = around_ > 0 ? std::abs(360.0 / step_.y) : undulation_.cols() - 1.0;
        const bool beside = !(across >= -rounding && across <= last + rounding);
        if (beside || !(down >= -rounding && down <= undulation_.rows() - 1.0 + rounding)) {
            return unknown;
        }
        const Cubic rows = cubic_at(down, undulation_.rows());
        const Cubic cols =
            around_ > 0 ? cubic_from(across, clamped_int(std::floor(across), -1, around_) - 1)
                        : cubic_at(across, undulation_.cols());
        return interpolated(cols, rows);
    }

private:
    /// Within 360 degrees of the first column.
    [[nodiscard]] double column_of(double longitude) const {
        const double turn = std::abs(360.0 / step_.y);
        const double across = (longitude - first_.y) / step_.y;
        return across - turn * std::floor((across + rounding) / turn);
    }
    [[nodiscard]] double interpolated(const Cubic& cols, const Cubic& rows) const {
        double sum = 0.0;
        for (std::size_t j = 0; j < 4; ++j) {
            for (std::size_t i = 0; i < 4; ++i) {
                int col = cols.first + static_cast<int>(i);
                col = around_ > 0 ? (col + around_) % around_ : col;
                sum += rows.weights[j] * cols.weights[i] *
                       static_cast<double>(undulation_(col, rows.first + static_cast<int>(j)));
            }
        }
        return sum;
    }

    Grid<float> undulation_;
    glm::dvec2 first_;
    glm::dvec2 step_;
    int around_ = 0; ///< columns in 360 degrees; 0: not a global grid
};

} // namespace

Geoid::Geoid(std::string name, Source source)
    : name_(std::move(name)), source_(std::move(source)) {}

Geoid::Geoid(std::string name, Grid<float> undulation, glm::dvec2 first, glm::dvec2 step)
    : name_(std::move(name)) {
    check(undulation.cols() >= 4 && undulation.rows() >= 4, "Geoid needs 4×4 heights");
    check(step.x != 0.0 && step.y != 0.0, "Geoid needs a step");
    check(std::isfinite(first.x + first.y + step.x + step.y), "Geoid needs a place");
    auto grid = std::make_shared<const UndulationGrid>(std::move(undulation), first, step);
    source_ = [grid](double latitude, double longitude) { return grid->at(latitude, longitude); };
}

Result<Geoid> Geoid::read_pgm(const std::filesystem::path& path) {
    try {
        const std::string folder = path.has_parent_path() ? path.parent_path().string() : ".";
        // Reads the whole file: thread-safe.
        const auto geoid =
            std::make_shared<const GeographicLib::Geoid>(path.stem().string(), folder, true, true);
        return Geoid(path.filename().string(), [geoid](double latitude, double longitude) {
            return (*geoid)(latitude, longitude);
        });
    } catch (const std::exception& error) { // also std::bad_alloc
        return Error{fmt::format("{}: cannot be read ({}), a geoid file of GeographicLib was "
                                 "expected",
                                 path.string(), error.what())};
    }
}

std::filesystem::path Geoid::installed_folder() {
    return GeographicLib::Geoid::DefaultGeoidPath();
}

double Geoid::undulation(double latitude, double longitude) const {
    check(std::abs(latitude) <= 90.0, "latitude outside [-90, 90]");
    return source_(latitude, longitude);
}

} // namespace reljef::geo
