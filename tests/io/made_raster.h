#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <gdal_priv.h>

namespace reljef::test {

/// A raster to write through GDAL: one value per sample and band, row after row, band after band.
struct MadeRaster {
    int cols = 0;
    int rows = 0;
    std::vector<double> values;
    GDALDataType type = GDT_Float32;
    int bands = 1;
    std::string format = "GTiff";
    std::string crs; ///< anything GDAL understands; empty: none
    std::optional<std::array<double, 6>> geotransform;
    std::optional<double> nodata;
    std::string unit;
    double scale = 1.0;
    double offset = 0.0;
    std::vector<GDALColorInterp> colors;
    std::vector<std::string> options; ///< of creation, "TILED=YES"
    std::vector<int> overviews;
    std::vector<GDALColorEntry> palette;
};

/// A raster with value(col, row) at every sample.
/// One note a line.
inline std::string joined(const std::vector<std::string>& notes) {
    std::string text;
    for (const std::string& note : notes) {
        text += note + "\n";
    }
    return text;
}

template <class Value> MadeRaster made_raster(int cols, int rows, const Value& value) {
    MadeRaster raster;
    raster.cols = cols;
    raster.rows = rows;
    for (int row = 0; row < rows; ++row) {
        for (int col = 0; col < cols; ++col) {
            raster.values.push_back(static_cast<double>(value(col, row)));
        }
    }
    return raster;
}

/// Writes it; false where GDAL cannot.
bool write(const MadeRaster& raster, const std::filesystem::path& path);

/// Keeps GDAL quiet for the scope.
class QuietGdal {
public:
    QuietGdal();
    ~QuietGdal();
    QuietGdal(const QuietGdal&) = delete;
    QuietGdal& operator=(const QuietGdal&) = delete;
};

} // namespace reljef::test
