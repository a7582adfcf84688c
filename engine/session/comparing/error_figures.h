#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "engine/core/color.h"
#include "engine/core/result.h"
#include "engine/truth/geometric_error.h"

namespace reljef::session {

/// How far points are from their true places on the picture, pixels.
struct PixelQuantiles {
    double median = 0.0;
    double p99 = 0.0;
    double p999 = 0.0; ///< 99.9 % of the pixels are at most so far off
    double max = 0.0;
};

/// The errors of a picture against the exact one.
struct ErrorFigures {
    bool has_terrain = true;    ///< false: neither the picture nor the exact one; nothing is wrong
    double wrong_percent = 0.0; ///< of all pixels: another surface, or none; see truth::Verdict
    double hole_percent = 0.0;  ///< of all pixels: no terrain where there is some
    /// Of the pixels that show terrain; absent if none has a finite error.
    std::optional<PixelQuantiles> pixels;
    std::size_t unbounded = 0;  ///< pixels with an infinite error, which have no quantile
    std::optional<double> psnr; ///< dB; absent: identical pictures
    std::optional<double> ssim; ///< absent: the picture is smaller than its window
};

/// Fails if the pictures differ in size. `threads` 0: as many as the machine has.
Result<ErrorFigures> error_figures(const truth::GeometricErrors& errors, const Image& shown,
                                   const Image& truth, unsigned threads = 0);

/// "0.02 % wrong, half within 0.1 px, 99.9 % within 0.9 px, at most 1 px, PSNR 41.2 dB, SSIM 0.99".
std::string to_string(const ErrorFigures& figures);

} // namespace reljef::session
