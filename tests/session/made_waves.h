#pragma once

#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include "engine/io/formats/raster_writer.h"

namespace reljef::test {

inline float height_of_waves(int col, int row) {
    return static_cast<float>(900.0 + 300.0 * std::sin(0.013 * col) * std::cos(0.021 * row) +
                              40.0 * std::sin(0.9 * col + 0.4 * row));
}

/// Writes a raster of waves in UTM, 10 m from sample to sample. A single one is a void (NaN) if it
/// is wide enough: (100, 70).
inline void write_waves(const std::filesystem::path& path, int cols, int rows) {
    const io::HeightRaster raster{
        .cols = cols, .rows = rows, .spacing = 10.0, .first = {300000.0, 5000000.0}};
    const auto written = io::write_heights(path, raster, [](int first, GridView<float> heights) {
        for (int row = 0; row < heights.rows(); ++row) {
            for (int col = 0; col < heights.cols(); ++col) {
                heights(col, row) = col == 100 && first + row == 70
                                        ? std::nanf("")
                                        : height_of_waves(col, first + row);
            }
        }
    });
    ASSERT_TRUE(written) << written.error().message;
}

} // namespace reljef::test
