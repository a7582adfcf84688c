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
    std::vector<std::array<std::string, 3>> metadata; ///< domain, key, value
};

/// One note a line.
inline std::string joined(const std::vector<std::string>& notes) {
    std::string text;
    for (const std::string& note : notes) {
        text += note + "\n";
    }
    return text;
}

/// A raster with value(col, row) at every sample.
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

struct SparseTiff {
    int cols = 0;
    int rows = 0;
    int bands = 1;
    std::vector<std::string> options; ///< of GDAL, beside the sparse blocks
};
/// Writes a TIFF of bytes without any stored block.
bool write(const SparseTiff& tiff, const std::filesystem::path& path);

/// Adds a member to a .zip, which is made if it does not exist.
bool add_to_zip(const std::filesystem::path& archive, const std::string& member,
                const std::string& bytes);

struct StretchedVrt {
    double step = 1.0; ///< metres between samples, from 300 km east, 5600 km north in UTM 31
    std::string type;  ///< as GDAL names it: "Byte"
    std::string overviews = {}; ///< "2 4 8", which GDAL makes as it reads; empty: none
};
/// The text of a virtual raster of 65,536 samples a side, all of them those of the 256 a side that
/// `source`, beside it, has.
std::string stretched_vrt(const std::string& source, const StretchedVrt& vrt);

/// Keeps GDAL quiet for the scope.
class QuietGdal {
public:
    QuietGdal();
    ~QuietGdal();
    QuietGdal(const QuietGdal&) = delete;
    QuietGdal& operator=(const QuietGdal&) = delete;
};

} // namespace reljef::test
