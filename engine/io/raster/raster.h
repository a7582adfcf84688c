#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "engine/core/parallel_for.h"
#include "engine/core/result.h"
#include "engine/terrain/field/heightfield.h"

namespace reljef::io {

struct RasterOptions {
    /// Bytes for the terrain, CPU and GPU. A larger raster is read at the smallest integer
    /// reduction that fits (bytes_per_sample), with a note.
    std::size_t memory_budget = std::size_t{512} << 20;
    struct Window {
        int col = 0, row = 0, cols = 0, rows = 0;
    };
    std::optional<Window> window;  ///< part to read, in full-resolution samples
    std::optional<double> spacing; ///< metres; an error for rasters with a CRS
    /// height = value · height_scale + height_offset, metres; finite, scale not 0.
    double height_scale = 1.0;
    double height_offset = 0.0;
    /// Images to drape: georeferenced images in any CRS and folders of them, or one image without a
    /// place, which is stretched over the raster. The finest is on top.
    std::vector<std::filesystem::path> imagery;
    /// Stored values that are voids though the file does not declare them; see undeclared_voids.
    /// Absent: all usual voids.
    std::optional<std::vector<double>> undeclared_voids;
    std::optional<double> imagery_white; ///< see ImagerySet::white(); absent: searched
    Progress progress;
    std::stop_token stop;
};

/// Bounds the memory of a terrain in bytes per sample: heights, their pyramid, error bounds or
/// cones, and textures (Memory.StaysWithinTheBudget), but not the triangles of all samples.
inline constexpr std::size_t bytes_per_sample = 40;

/// Maximum side of a draped image, pixels.
inline constexpr int max_image_side = 4096;

/// Whether files may refer to files anywhere (references.h) and be in any format of GDAL; not at
/// first. For the whole process, as GDAL's formats are. Call before other threads open files.
void allow_external(bool allowed);

/// Limits GDAL's block cache, which all readers share.
void limit_block_cache(std::size_t bytes);

/// Whether a name ends in .tif or .tiff, or the same in capitals.
bool names_geotiff(const std::filesystem::path& path);

/// Metadata of a raster.
struct RasterInfo {
    int cols = 0;
    int rows = 0;
    std::string format;   ///< GDAL's driver, "SRTMHGT"
    std::string type;     ///< "Int16", "Float32", …
    std::string crs_name; ///< empty without a CRS
};

Result<RasterInfo> read_raster_info(const std::filesystem::path& path);

} // namespace reljef::io
