#pragma once

#include <filesystem>
#include <stop_token>

#include <glm/vec2.hpp>

#include "bench/runner/suite_options.h"
#include "engine/core/result.h"

namespace reljef::bench {

/// The ground that a growing number of samples shows: a square of 40 km, a sum of waves. Metres at
/// a sample of a raster of `side` samples a side; the rasters hold it as floats do.
double growth_height(glm::ivec2 sample, int side);

/// Writes it as a GeoTIFF, tiled and with overviews.
Result<void> write_growth_ground(const std::filesystem::path& path, int side,
                                 const SuiteOptions& suite, const std::stop_token& stop);

/// A folder for such rasters, removed with all that it holds.
class GrowthFolder {
public:
    /// In `parent`, empty: where the system has such files. Fails where there is no room for a
    /// raster of `most` samples a side.
    static Result<GrowthFolder> create(const std::filesystem::path& parent, int most);
    GrowthFolder(GrowthFolder&& other) noexcept;
    GrowthFolder& operator=(GrowthFolder&&) = delete;
    GrowthFolder(const GrowthFolder&) = delete;
    GrowthFolder& operator=(const GrowthFolder&) = delete;
    ~GrowthFolder();

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
    explicit GrowthFolder(std::filesystem::path path) : path_(std::move(path)) {}

    std::filesystem::path path_;
    bool is_made_ = false;
};

} // namespace reljef::bench
