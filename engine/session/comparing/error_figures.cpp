#include "engine/session/comparing/error_figures.h"

#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "engine/core/statistics.h"
#include "engine/truth/image_error.h"

namespace reljef::session {
namespace {

std::optional<PixelQuantiles> quantiles_of(const truth::PixelErrors& errors) {
    if (!errors.distribution) {
        return std::nullopt;
    }
    std::vector<double> finite;
    finite.reserve(errors.distribution->count);
    for (const float error : errors.map.samples()) {
        if (std::isfinite(error)) {
            finite.push_back(error);
        }
    }
    constexpr double nearly_all = 0.999;
    return PixelQuantiles{errors.distribution->median, errors.distribution->p99,
                          quantile(finite, nearly_all), errors.distribution->max};
}

} // namespace

Result<ErrorFigures> error_figures(const truth::GeometricErrors& errors, const Image& shown,
                                   const Image& truth, unsigned threads) {
    const auto rmse = truth::root_mean_square_error(shown, truth);
    if (!rmse) {
        return rmse.error();
    }
    ErrorFigures figures;
    figures.wrong_percent = errors.wrong_percent;
    figures.hole_percent =
        100.0 * static_cast<double>(errors.holes) / static_cast<double>(errors.verdicts.size());
    figures.pixels = quantiles_of(errors.reprojection);
    figures.unbounded = errors.reprojection.unbounded;
    if (*rmse > 0.0) {
        figures.psnr = truth::peak_signal_to_noise(*rmse);
    }
    if (const auto ssim = truth::structural_similarity(shown, truth, threads)) {
        figures.ssim = *ssim;
    }
    return figures;
}

std::string to_string(const ErrorFigures& figures) {
    if (!figures.has_terrain) {
        return "no terrain in the view, true or shown: no pixel to compare";
    }
    std::string text = fmt::format("{:.3g} % wrong", figures.wrong_percent);
    if (figures.hole_percent > 0.0) {
        text += fmt::format(" ({:.3g} % holes)", figures.hole_percent);
    }
    if (figures.pixels) {
        text += fmt::format(
            ", half within {:.2g} px, 99 % within {:.2g} px, 99.9 % within {:.2g} px, at most "
            "{:.3g} px",
            figures.pixels->median, figures.pixels->p99, figures.pixels->p999, figures.pixels->max);
    }
    if (figures.unbounded > 0) {
        text += fmt::format(", {} pixels without a bound", figures.unbounded);
    }
    text += figures.psnr ? fmt::format(", PSNR {:.1f} dB", *figures.psnr) : ", identical pictures";
    return figures.ssim ? text + fmt::format(", SSIM {:.4f}", *figures.ssim) : text;
}

} // namespace reljef::session
