#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <glm/vec2.hpp>

#include "engine/core/grid.h"
#include "engine/core/result.h"

namespace reljef::geo {

/// How far the geoid (mean sea level) lies above the WGS 84 ellipsoid. Cheap to copy, safe from
/// several threads at a time.
class Geoid {
public:
    /// From heights on a grid of degrees: `undulation(i, j)` in metres lies at latitude
    /// first.x + j·step.x, longitude first.y + i·step.y. Between them four-point Lagrange
    /// interpolation. A grid that goes round the Earth has no seam; of another only what it covers
    /// is known. Preconditions: at least 4×4 heights, step not 0.
    Geoid(std::string name, Grid<float> undulation, glm::dvec2 first, glm::dvec2 step);

    /// A file of GeographicLib's own (egm96-15.pgm, …), through GeographicLib with its cubic
    /// interpolation.
    static Result<Geoid> read_pgm(const std::filesystem::path& path);

    /// Where GeographicLib looks for its files on this machine; the folder may not exist.
    static std::filesystem::path installed_folder();

    /// What the user knows it by: the file's name.
    [[nodiscard]] const std::string& name() const { return name_; }
    /// Metres above the ellipsoid; NaN where it is not known. Precondition: latitude in [-90, 90].
    [[nodiscard]] double undulation(double latitude, double longitude) const;

private:
    class Source;
    class GridSource;
    class FileSource;
    Geoid(std::string name, std::shared_ptr<const Source> source);

    std::string name_;
    std::shared_ptr<const Source> source_;
};

} // namespace reljef::geo
