#include "engine/io/raster/globe.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/io/raster/georeferencing.h"

namespace reljef::io {
namespace {

constexpr double same_place = 1e-2; // of a step: what a whole turn of steps with few digits misses
constexpr double at_pole = 1e-6;    // of a step
constexpr int min_around = 4;

double whole_turn(const OGRSpatialReference& crs) {
    return 2.0 * std::numbers::pi / crs.GetAngularUnits();
}

/// Steps from a row to the pole that closes the raster, 0 where none does.
double steps_to_pole(double latitude, double pole, double step) {
    const double steps = (pole - latitude) / step;
    return steps > at_pole && steps <= 1.0 + at_pole ? steps : 0.0;
}

template <class T> Grid<T> with_room(const Grid<T>& grid, const geo::GlobalWrap& closing) {
    Grid<T> result(grid.cols() + closing.cols(), grid.rows() + closing.rows());
    for (int row = 0; row < grid.rows(); ++row) {
        const auto target = result.row(row + closing.north_rows());
        std::copy(grid.row(row).begin(), grid.row(row).end(), target.begin());
        if (closing.east) {
            target[target.size() - 1] = target[0];
        }
    }
    return result;
}

template <class T> void fill_row(Grid<T>& grid, int row, T value) {
    std::fill(grid.row(row).begin(), grid.row(row).end(), value);
}

/// The mean of a row's heights; of its first `cols`, each place once.
struct RowMean {
    float height = 0.0F;
    bool is_void = false;
};

RowMean mean_of_row(const Grid<float>& heights, const Grid<std::uint8_t>& voids, int row,
                    int cols) {
    double sum = 0.0;
    double filled = 0.0;
    int count = 0;
    for (int col = 0; col < cols; ++col) {
        filled += heights(col, row);
        if (voids.empty() || voids(col, row) == 0) {
            sum += heights(col, row);
            ++count;
        }
    }
    return {static_cast<float>(count > 0 ? sum / count : filled / cols), count == 0};
}

void close_pole(Grid<float>& heights, Grid<std::uint8_t>& voids, int pole_row, int outermost,
                int cols) {
    const RowMean mean = mean_of_row(heights, voids, outermost, cols);
    fill_row(heights, pole_row, mean.height);
    if (!voids.empty()) {
        fill_row(voids, pole_row, static_cast<std::uint8_t>(mean.is_void ? 1 : 0));
    }
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

int samples_around(GDALDataset& dataset) {
    std::vector<std::string> ignored;
    const auto affine = affine_of(dataset);
    const auto crs = affine ? horizontal_crs(dataset, ignored) : std::nullopt;
    return crs ? samples_around(*crs, *affine) : 0;
}

geo::GlobalWrap closing_of(const OGRSpatialReference& crs, const geo::PixelAffine& affine, int cols,
                           int rows) {
    const int around = samples_around(crs, affine);
    geo::GlobalWrap closing;
    if (around == 0 || cols < around || cols > around + 1 || affine.y_row >= 0.0) {
        return closing;
    }
    closing.around = true;
    closing.east = cols == around;
    const double pole = 0.25 * whole_turn(crs);
    const double step = -affine.y_row;
    closing.north = steps_to_pole(affine.y0, pole, step);
    closing.south = steps_to_pole(-(affine.y0 - step * (rows - 1)), pole, step);
    return closing;
}

SampleGrid closed(SampleGrid grid, const geo::GlobalWrap& closing) {
    grid.origin.y -= grid.step.y * closing.north_rows();
    grid.cols += closing.cols();
    grid.rows += closing.rows();
    return grid;
}

void close_samples(Grid<float>& heights, Grid<std::uint8_t>& void_mask,
                   const geo::GlobalWrap& closing) {
    if (closing.cols() == 0 && closing.rows() == 0) {
        return;
    }
    const int cols = heights.cols();
    heights = with_room(heights, closing);
    void_mask = void_mask.empty() ? std::move(void_mask) : with_room(void_mask, closing);
    if (closing.north > 0.0) {
        close_pole(heights, void_mask, 0, 1, cols);
    }
    if (closing.south > 0.0) {
        close_pole(heights, void_mask, heights.rows() - 1, heights.rows() - 2, cols);
    }
}

} // namespace reljef::io
