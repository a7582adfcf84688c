#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <vector>

#include "engine/io/raster/mixed_overviews.h"

namespace reljef::io {

struct CheckedRaster {
    Dataset dataset;                     ///< without overviews if they mix voids with heights
    std::optional<bool> mixed_overviews; ///< see overviews_mix_voids
    std::optional<std::vector<double>> undeclared_voids; ///< see the function of this name
};

/// As open_raster, but ignores overviews that mix voids with heights. Fails for an ASCII grid with
/// missing values, which costs GDAL exponential time.
Result<CheckedRaster> open_whole_raster(const std::filesystem::path& path,
                                        const GdalMessages& messages);

/// open_whole_raster that checks each version of a file only once. Thread-safe.
class WholeRasters {
public:
    Result<CheckedRaster> open(const std::filesystem::path& path, const GdalMessages& messages);

    /// Of a file that was opened; the same for all its tiles.
    [[nodiscard]] std::optional<std::vector<double>>
    undeclared_voids(const std::filesystem::path& path) const;

private:
    struct Known {
        std::filesystem::file_time_type changed;
        std::optional<bool> mixed_overviews;
        std::optional<std::vector<double>> undeclared_voids;
    };
    mutable std::mutex mutex_;
    std::map<std::filesystem::path, Known> whole_;
};

} // namespace reljef::io
