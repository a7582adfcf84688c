#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "engine/core/back_off.h"
#include "engine/core/color.h"
#include "engine/core/result.h"
#include "engine/io/files/tile_grid.h"
#include "engine/io/raster/web_tiles.h"

namespace reljef::io {

/// Part of an ImagerySet's picture.
struct ImageryWindow {
    Image texels;          ///< alpha 0 outside the images
    bool whole = true;     ///< false: an image that may contribute was skipped
    bool has_more = false; ///< an image that contributes, or may, is finer than the texels
    std::vector<FileError> errors;
};

struct ImagerySetOptions {
    /// Bytes per reading thread, beside GDAL's block cache; at least 1 MB.
    std::size_t reading_memory = std::size_t{64} << 20;
    std::chrono::milliseconds first_pause = BackOff::usual_first_pause; ///< see BackOff
    std::stop_token stop = {};                                          ///< for open()
};

/// Georeferenced images of any CRS as one picture, read on demand. Where images overlap, the finest
/// wins; ties go to the newest. Thread-safe.
class ImagerySet {
public:
    /// `crs`: WKT of the grids to read, and of images without a CRS of their own. Skips images that
    /// cannot be opened or have no place (or only ground control points). Fails if none is left or
    /// if stopped.
    static Result<ImagerySet> open(std::span<const std::filesystem::path> names,
                                   const std::string& crs, const ImagerySetOptions& options = {});

    [[nodiscard]] std::size_t size() const;
    /// See RasterOptions::imagery_white.
    [[nodiscard]] double white() const;
    /// Pixel size of the finest image at its middle, metres.
    [[nodiscard]] double finest_pixel() const;

    /// The picture at the positions of `grid`, `spacing` metres apart, from the coarsest overviews
    /// that are fine enough. Neighbouring grids have the same texels in shared rows and columns
    /// (errors of positions reach 0.1 texel if `reading_memory` is too small). Skips images that
    /// need more than `max_pixels_read` and those that fail repeatedly (BackOff), without an error.
    [[nodiscard]] ImageryWindow read(const TileGrid& grid, double spacing,
                                     const std::stop_token& stop = {}) const;
    static constexpr double max_pixels_read = 1U << 26U;

    /// As those of TileSet.
    [[nodiscard]] std::uint64_t changes() const;
    [[nodiscard]] std::vector<std::string> take_new_notes() const;
    /// A warning for the first image that coarse views skip for lack of overviews, with the command
    /// that adds them.
    [[nodiscard]] std::optional<std::string> missing_overviews() const;

private:
    struct State;
    explicit ImagerySet(std::shared_ptr<const State> state) : state_(std::move(state)) {}
    std::shared_ptr<const State> state_;
};

/// Replaces the texels beyond a pole by those at the pole's row. The picture's texels lie edge to
/// edge over `samples` of the closed rows, starting at row `first`.
void wrap_picture(Image& picture, const geo::WrappedRows& rows, double first, double samples);

} // namespace reljef::io
