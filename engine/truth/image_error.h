#pragma once

#include <optional>

#include "engine/core/color.h"
#include "engine/core/grid.h"
#include "engine/core/result.h"
#include "engine/truth/flip.h"

namespace reljef::truth {

/// How far a picture is from the true one. Alpha is never looked at.
struct ImageErrors {
    double rmse = 0.0; ///< see root_mean_square_error()
    double psnr = 0.0; ///< see peak_signal_to_noise()
    /// See structural_similarity(); absent where the picture is smaller than its window.
    std::optional<double> ssim;
    Flip flip; ///< see flip()
};

/// Root of the mean square difference of the sRGB-encoded channels r, g and b, each in [0,1].
/// Fails where the pictures are empty or differ in size.
Result<double> root_mean_square_error(const Image& shown, const Image& truth);

/// 20·log10(1 / rmse), dB, for a signal in [0,1]. Identical pictures (rmse 0) give infinity, which
/// JSON, having none, is told as null.
double peak_signal_to_noise(double rmse);

/// Samples on a side of the window that structural_similarity() looks through.
constexpr int similarity_window = 11;

/// Mean SSIM of the lumas (ITU-R BT.601 weights of the sRGB-encoded channels, in [0,255]), in
/// [−1,1], 1 for identical pictures: Gaussian window of 11×11 samples, σ = 1.5, K1 = 0.01,
/// K2 = 0.03, no scaling down (Wang, Bovik, Sheikh and Simoncelli 2004, "Image Quality Assessment:
/// From Error Visibility to Structural Similarity"). The mean goes over the windows that lie wholly
/// inside the picture: the outer 5 pixels are no centres. `threads` as in FlipOptions. Fails where
/// the pictures differ in size or are smaller than the window.
Result<double> structural_similarity(const Image& shown, const Image& truth, unsigned threads = 0);

/// All of them. Fails where the pictures are empty or differ in size.
Result<ImageErrors> image_errors(const Image& shown, const Image& truth,
                                 const FlipOptions& options = {});

} // namespace reljef::truth
