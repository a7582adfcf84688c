#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include <glm/vec2.hpp>

#include "engine/core/grid.h"
#include "engine/core/result.h"

namespace reljef::geo {

/// Height of the geoid (mean sea level) above the WGS 84 ellipsoid. Cheap to copy, thread-safe.
class Geoid {
public:
    /// `undulation(i, j)` in metres lies at latitude first.x + j·step.x, longitude
    /// first.y + i·step.y, in degrees. Four-point Lagrange interpolation, seamless for a global
    /// grid. Preconditions: at least 4×4 heights, `first` and `step` finite, step not 0.
    Geoid(std::string name, Grid<float> undulation, glm::dvec2 first, glm::dvec2 step);

    /// Reads a geoid file of GeographicLib (egm96-15.pgm, …); cubic interpolation.
    static Result<Geoid> read_pgm(const std::filesystem::path& path);

    /// GeographicLib's folder of geoid files; it may not exist.
    static std::filesystem::path installed_folder();

    /// File name.
    [[nodiscard]] const std::string& name() const { return name_; }
    /// Metres above the ellipsoid; NaN outside the grid. Precondition: latitude in [-90, 90].
    [[nodiscard]] double undulation(double latitude, double longitude) const;

private:
    using Source = std::function<double(double latitude, double longitude)>;
    Geoid(std::string name, Source source);

    std::string name_;
    Source source_;
};

} // namespace reljef::geo
