#pragma once

#include <cmath>
#include <numbers>

namespace reljef::test {

/// A raster of the whole Earth.
struct MadeGlobe {
    int cols = 1100;       ///< around
    int rows = 300;        ///< from pole to pole, or from 75° north to 75° south
    bool on_lines = false; ///< the outermost rows lie on the poles and the first column at -180°
    bool repeats = false;  ///< the first column again at the end
    bool has_poles = true;
    /// About how much of it has no height: in rings of all sizes, which also cover a pole and lie
    /// across the seam; 0: nothing.
    double voids = 0.0;

    [[nodiscard]] bool is_void(int col, int row) const {
        const double latitude_here = latitude(row) * std::numbers::pi / 180.0;
        const double longitude_here = longitude(col) * std::numbers::pi / 180.0;
        const double wave = std::sin(3.0 * longitude_here + 1.7) * std::cos(9.0 * latitude_here) +
                            std::sin(40.0 * longitude_here) * std::cos(37.0 * latitude_here);
        const bool is_at_pole = latitude(row) > 82.0;
        return voids > 0.0 &&
               (is_at_pole || wave > 1.6 - 2.0 * voids || (col * 7 + row * 13) % 97 == 0);
    }
    [[nodiscard]] double col_step() const { return 360.0 / cols; }
    [[nodiscard]] double row_step() const {
        return (has_poles ? 180.0 : 150.0) / (on_lines ? rows - 1 : rows);
    }
    /// Of a sample, degrees.
    [[nodiscard]] double latitude(int row) const {
        return (has_poles ? 90.0 : 75.0) - (row + (on_lines ? 0.0 : 0.5)) * row_step();
    }
    [[nodiscard]] double longitude(int col) const {
        return -180.0 + (col + (on_lines ? 0.0 : 0.5)) * col_step();
    }
    /// Metres; one height at each pole.
    [[nodiscard]] double height(int col, int row) const {
        const double latitude_here = latitude(row) * std::numbers::pi / 180.0;
        const double longitude_here = longitude(col) * std::numbers::pi / 180.0;
        constexpr double rounding = 1e-9; // degrees
        const bool is_pole = std::abs(latitude(row)) > 90.0 - rounding;
        const double to_axis = is_pole ? 0.0 : std::cos(latitude_here);
        const double x = to_axis * std::cos(longitude_here);
        const double y = to_axis * std::sin(longitude_here);
        const double z = std::sin(latitude_here);
        return std::round(1500.0 + 900.0 * std::sin(7.0 * x + 2.0 * y) * std::cos(5.0 * z + y) +
                          300.0 * std::sin(61.0 * x + 1.0) * std::cos(53.0 * y - 29.0 * z) +
                          80.0 * std::sin(311.0 * x) * std::cos(287.0 * y + 301.0 * z));
    }
};

} // namespace reljef::test
