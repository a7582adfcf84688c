#include "engine/io/raster/globe.h"

#include <cmath>
#include <numbers>

namespace reljef::io {
namespace {

constexpr double same_place = 1e-2; // steps: error of 360 degrees in rounded steps
constexpr double at_pole = 1e-6;    // steps
constexpr int min_around = 4;

double whole_turn(const OGRSpatialReference& crs) {
    return 2.0 * std::numbers::pi / crs.GetAngularUnits();
}

/// Steps from a row to a pole at most one step away; else 0.
double steps_to_pole(double latitude, double pole, double step) {
    const double steps = (pole - latitude) / step;
    return steps > at_pole && steps <= 1.0 + at_pole ? steps : 0.0;
}

/// Whether the outermost row lies on a pole once the raster is closed.
bool is_at_pole(double latitude, double pole, double step) {
    return std::abs(pole - latitude) <= (1.0 + at_pole) * step;
}

} // namespace

int samples_around(const OGRSpatialReference& crs, const geo::PixelAffine& affine) {
    const bool level = affine.x_row == 0.0 && affine.y_col == 0.0;
    if (crs.IsGeographic() == 0 || !level || affine.x_col == 0.0) {
        return 0;
    }
    const double samples = whole_turn(crs) / std::abs(affine.x_col);
    const double whole = std::round(samples);
    const bool closes =
        whole >= min_around && whole < 1e9 && std::abs(samples - whole) <= same_place;
    return closes ? static_cast<int>(whole) : 0;
}

geo::GlobalWrap closing_of(const OGRSpatialReference& crs, const geo::PixelAffine& affine, int cols,
                           int rows) {
    const int around = samples_around(crs, affine);
    geo::GlobalWrap wrap;
    if (around == 0 || cols < around || cols > around + 1 || affine.y_row >= 0.0) {
        return wrap;
    }
    wrap.around = true;
    wrap.east = cols == around;
    const double pole = 0.25 * whole_turn(crs);
    const double step = -affine.y_row;
    const double northmost = affine.y0;
    const double southmost = affine.y0 - step * (rows - 1);
    wrap.north = steps_to_pole(northmost, pole, step);
    wrap.south = steps_to_pole(-southmost, pole, step);
    wrap.begins_at_pole = is_at_pole(northmost, pole, step);
    wrap.ends_at_pole = is_at_pole(-southmost, pole, step);
    return wrap;
}

SampleGrid closed(SampleGrid grid, const geo::GlobalWrap& wrap) {
    grid.origin.y -= grid.step.y * wrap.north_rows();
    grid.cols += wrap.cols();
    grid.rows += wrap.rows();
    return grid;
}

} // namespace reljef::io
