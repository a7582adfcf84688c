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
#include "engine/core/parallel_for.h"
#include "engine/core/result.h"
#include "engine/io/files/tile_grid.h"
#include "engine/io/raster/web_tiles.h"

namespace reljef::io {

/// The raster of heights that images lie over.
struct ImageryGround {
    std::string crs;         ///< WKT; empty: no place on Earth, so images are stretched over it
    geo::PixelAffine affine; ///< of its pixels; (0,0) is the outer corner
    glm::ivec2 size{0};
};

/// Texels to read. `affine` maps them to the ground's coordinates; (0,0) is the middle of a texel.
struct TexelGrid {
    geo::PixelAffine affine;
    int cols = 0;
    int rows = 0;
};
inline TexelGrid texels_at(const TileGrid& grid) {
    return {affine_of(grid), grid.cols, grid.rows};
}

/// Part of an ImagerySet's picture.
struct ImageryWindow {
    Image texels;      ///< alpha 0 outside the images
    bool whole = true; ///< false: an image that may contribute, or all without a place, was skipped
    bool has_more = false; ///< an image that contributes, or may, is finer than the texels
    std::vector<FileError> errors;
    std::filesystem::path needs_overviews = {}; ///< an image that was left out: max_pixels
};

struct ImagerySetOptions {
    /// Bytes per reading thread, beside GDAL's block cache; at least 1 MB.
    std::size_t reading_memory = std::size_t{64} << 20;
    bool keeps_open = true;                                             ///< files that were read
    std::chrono::milliseconds first_pause = BackOff::usual_first_pause; ///< see BackOff
    std::optional<double> white = {};                                   ///< absent: searched
    std::stop_token stop = {};                                          ///< for open()
};

struct ImageryReading {
    double max_pixels = 1U << 26U; ///< images that need more are left out
    Progress progress = {};
    std::stop_token stop = {};
};

/// Images of any CRS as one picture over a ground, read on demand. Where images overlap, the finest
/// wins; ties go to the newest. Thread-safe.
class ImagerySet {
public:
    /// Images without a CRS have the ground's. Those without a place are stretched over the ground
    /// if no image has one; else they are left out, with a note. Fails if no image can be opened or
    /// if stopped.
    static Result<ImagerySet> open(std::span<const std::filesystem::path> names,
                                   const ImageryGround& ground,
                                   const ImagerySetOptions& options = {});

    [[nodiscard]] std::size_t size() const;
    [[nodiscard]] std::span<const std::string> notes() const;
    [[nodiscard]] std::span<const std::string> errors() const; ///< of images that were left out
    /// See RasterOptions::imagery_white.
    [[nodiscard]] double white() const;
    /// Pixels of the finest image per step of a grid, where it meets the ground; absent if no image
    /// reaches into the grid.
    [[nodiscard]] std::optional<glm::dvec2> finest_pixels_in(const TexelGrid& grid) const;

    /// The picture at the positions of `grid`, from the coarsest overviews that are fine enough.
    /// Neighbouring grids have the same texels in shared rows and columns (errors of positions
    /// reach 0.1 texel if `reading_memory` is too small). Skips images that fail repeatedly
    /// (BackOff), without an error.
    [[nodiscard]] ImageryWindow read(const TexelGrid& grid,
                                     const ImageryReading& reading = {}) const;

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
