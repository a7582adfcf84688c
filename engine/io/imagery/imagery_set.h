#pragma once

#include <chrono>
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
#include "engine/io/tile_set.h"

namespace reljef::io {

/// What images show of a part of the Earth.
struct ImageryWindow {
    Image texels;          ///< alpha 0 where they show nothing
    bool whole = true;     ///< false: one that may show more was left out
    bool has_more = false; ///< one that is shown, or may be, has pixels finer than the texels
    std::vector<FileError> errors;
};

struct ImagerySetOptions {
    /// Bytes that each thread takes to read, beside GDAL's blocks; at least 1 MB.
    std::size_t reading_memory = std::size_t{64} << 20;
    std::chrono::milliseconds first_pause = BackOff::usual_first_pause; ///< see BackOff
    std::stop_token stop = {};                                          ///< of opening
};

/// Georeferenced images of any coordinate systems as one picture, read where and when it is asked
/// for. Where several show something the finest counts, of equally fine ones the newer. Safe from
/// several threads at a time.
class ImagerySet {
public:
    /// `crs`: WKT of the places that it will be asked for; images that have a place but name no
    /// coordinate system are in that. Images without a place (or only with ground control points),
    /// and those that cannot be opened, are left out. Fails where none is left, or it was stopped.
    static Result<ImagerySet> open(std::span<const std::filesystem::path> names,
                                   const std::string& crs, const ImagerySetOptions& options = {});

    [[nodiscard]] std::size_t size() const;
    /// What the images' colours are divided by: see RasterOptions::imagery_white.
    [[nodiscard]] double white() const;
    /// Metres, a side of the finest image's pixels at its middle.
    [[nodiscard]] double finest_pixel() const;

    /// The picture at the places of `grid`, `spacing` metres apart, from the overviews that are
    /// just finer. Neighbours that share a row or a column of places have the same texels there
    /// (places are right to a tenth of a texel where `reading_memory` holds no whole reading). An
    /// image of which more than `max_pixels_read` would be read is left out, and one that is given
    /// up for now, as BackOff says, without a fault.
    [[nodiscard]] ImageryWindow read(const TileGrid& grid, double spacing,
                                     const std::stop_token& stop = {}) const;
    static constexpr double max_pixels_read = 1U << 26U;
    static constexpr int max_failures = BackOff::max_attempts;

    /// Where an image is so large that it is left out of coarse views, because it has no overviews:
    /// a sentence that names the first such file and the command that makes them.
    [[nodiscard]] std::optional<std::string> missing_overviews() const;

private:
    struct State;
    explicit ImagerySet(std::shared_ptr<const State> state) : state_(std::move(state)) {}
    std::shared_ptr<const State> state_;
};

} // namespace reljef::io
