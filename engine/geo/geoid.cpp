#include "engine/geo/geoid.h"

#include <cmath>
#include <limits>
#include <utility>

#include <GeographicLib/Geoid.hpp>
#include <fmt/format.h>
#include <glm/common.hpp>

#include "engine/core/check.h"
#include "engine/geo/cubic.h"

namespace reljef::geo {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
// Of a control point: what steps such as 1/60 lose by rounding over a whole turn.
constexpr double rounding = 1e-6;

} // namespace

class Geoid::Source {
public:
    Source() = default;
    Source(const Source&) = delete;
    Source& operator=(const Source&) = delete;
    virtual ~Source() = default;
    [[nodiscard]] virtual double undulation(double latitude, double longitude) const = 0;
};

class Geoid::GridSource : public Geoid::Source {
public:
    GridSource(Grid<float> undulation, glm::dvec2 first, glm::dvec2 step)
        : undulation_(std::move(undulation)), first_(first), step_(step) {
        const double turn = std::abs(360.0 / step.y);
        around_ = undulation_.cols() >= turn - rounding ? static_cast<int>(std::lround(turn)) : 0;
    }

    [[nodiscard]] double undulation(double latitude, double longitude) const override {
        const double down = (latitude - first_.x) / step_.x;
        const double across = column_of(longitude);
        const double last = undulation_.cols() - 1.0;
        const bool beside = around_ == 0 && !(across >= -rounding && across <= last + rounding);
        if (beside || !(down >= -rounding && down <= undulation_.rows() - 1.0 + rounding)) {
            return unknown;
        }
        const Cubic rows = cubic_at(down, undulation_.rows());
        const Cubic cols = around_ > 0
                               ? cubic_from(across, static_cast<int>(std::floor(across)) - 1)
                               : cubic_at(across, undulation_.cols());
        return interpolated(cols, rows);
    }

private:
    /// Within one turn from the first column.
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
    int around_ = 0; ///< columns in a whole turn; 0: the grid does not go round
};

class Geoid::FileSource : public Geoid::Source {
public:
    FileSource(const std::string& name, const std::string& folder)
        : geoid_(name, folder, true, true) {}
    [[nodiscard]] double undulation(double latitude, double longitude) const override {
        return geoid_(latitude, longitude);
    }

private:
    GeographicLib::Geoid geoid_; // reads the whole file, so that threads may share it
};

Geoid::Geoid(std::string name, std::shared_ptr<const Source> source)
    : name_(std::move(name)), source_(std::move(source)) {}

Geoid::Geoid(std::string name, Grid<float> undulation, glm::dvec2 first, glm::dvec2 step)
    : name_(std::move(name)) {
    check(undulation.cols() >= 4 && undulation.rows() >= 4, "Geoid needs 4×4 heights");
    check(step.x != 0.0 && step.y != 0.0, "Geoid needs a step");
    source_ = std::make_shared<GridSource>(std::move(undulation), first, step);
}

Result<Geoid> Geoid::read_pgm(const std::filesystem::path& path) {
    try {
        auto source = std::make_shared<FileSource>(
            path.stem().string(),
            path.parent_path().empty() ? std::string(".") : path.parent_path().string());
        return Geoid(path.filename().string(), std::move(source));
    } catch (const std::exception& error) { // GeographicLib's, and of too little memory
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
    return source_->undulation(latitude, longitude);
}

} // namespace reljef::geo
