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
    /// Memory for the terrain, CPU and GPU, bytes. A raster that needs more (bytes_per_sample each)
    /// is read at the finest whole-number reduction that fits, with a note that says so.
    std::size_t memory_budget = std::size_t{512} << 20;
    /// Only this part of the raster, in its own full-resolution samples.
    struct Window {
        int col = 0, row = 0, cols = 0, rows = 0;
    };
    std::optional<Window> window;
    /// Metres between samples, for rasters that name no coordinate system (an error for the
    /// others).
    std::optional<double> spacing;
    /// Height in metres = value in metres · height_scale + height_offset; finite, scale not 0. For
    /// pictures whose grey values stand for another range than metres.
    double height_scale = 1.0;
    double height_offset = 0.0;
    /// Colour to drape: georeferenced images that overlap, each in any CRS, folders of them, or an
    /// image without a place, which is stretched over the whole raster, corner pixels on corner
    /// samples. The finest counts, where it shows nothing the next. Empty: none.
    std::vector<std::filesystem::path> imagery;
    /// Where it is known already (ImagerySet::white) the images are not looked through for it.
    std::optional<double> imagery_white;
    Progress progress;
    std::stop_token stop;
};

/// Bytes a terrain takes per sample once it is drawn: height, vertex, gradient, colour with
/// mipmaps, void mask.
inline constexpr std::size_t bytes_per_sample = 40;

/// The longest side of a draped image, pixels.
inline constexpr int longest_image_side = 4096;

/// How much GDAL keeps of what it has read, bytes, for all readers together.
void limit_block_cache(std::size_t bytes);

/// What a raster says of itself, without reading its samples.
struct RasterInfo {
    int cols = 0;
    int rows = 0;
    std::string format; ///< GDAL's driver, "SRTMHGT"
    std::string type;   ///< "Int16", "Float32", …
    std::string crs_name;
    std::string crs_code;
    std::string horizontal_unit;
    std::string vertical_unit; ///< "metre", "US survey foot", …; "metre" where the file names none
};

/// Errors as read_terrain has them for a file that does not open.
Result<RasterInfo> read_raster_info(const std::filesystem::path& path);

} // namespace reljef::io
