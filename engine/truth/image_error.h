#pragma once

#include <optional>

#include "engine/core/color.h"
#include "engine/core/grid.h"
#include "engine/core/result.h"
#include "engine/truth/flip.h"

namespace reljef::truth {

/// Errors of a picture against the true one. Alpha is ignored.
struct ImageErrors {
    double rmse = 0.0;
    double psnr = 0.0;
    std::optional<double> ssim; ///< structural_similarity(); absent below its window's size
    Flip flip;
};

/// Over the sRGB-encoded channels r, g and b, each in [0,1]. Fails as check_same_size().
Result<double> root_mean_square_error(const Image& shown, const Image& truth);

/// 20·log10(1 / rmse), dB, for a signal in [0,1]; infinity for identical pictures.
double peak_signal_to_noise(double rmse);

/// Side of structural_similarity()'s window, samples.
constexpr int similarity_window = 11;

/// Mean SSIM of the lumas (ITU-R BT.601 weights of the sRGB-encoded channels, in [0,255]), in
/// [−1,1], 1 for identical pictures: Gaussian window of 11×11 samples, σ = 1.5, K1 = 0.01,
/// K2 = 0.03, no downscaling (Wang, Bovik, Sheikh and Simoncelli 2004, "Image Quality Assessment:
/// From Error Visibility to Structural Similarity"). Only windows inside the picture count.
/// `threads` as in FlipOptions. Fails when the pictures differ in size or are smaller than the
/// window.
Result<double> structural_similarity(const Image& shown, const Image& truth, unsigned threads = 0);

/// Fails as check_same_size().
Result<ImageErrors> image_errors(const Image& shown, const Image& truth,
                                 const FlipOptions& options = {});

} // namespace reljef::truth
