#include "engine/truth/image_error.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <fmt/format.h>

#include "engine/truth/separable_filter.h"

namespace reljef::truth {
namespace {

double squared_difference(std::uint8_t a, std::uint8_t b) {
    const double difference = (static_cast<double>(a) - b) / 255.0;
    return difference * difference;
}

Plane luma_of(const Image& picture) {
    Plane luma(picture.cols(), picture.rows());
    std::ranges::transform(picture.samples(), luma.samples().begin(), [](Rgba8 color) {
        return 0.299 * color.r + 0.587 * color.g + 0.114 * color.b;
    });
    return luma;
}

Plane product(const Plane& a, const Plane& b) {
    Plane result(a.cols(), a.rows());
    std::ranges::transform(a.samples(), b.samples(), result.samples().begin(), std::multiplies());
    return result;
}

// Windowed means of two lumas and of their products.
struct Moments {
    Plane x;
    Plane y;
    Plane xx;
    Plane yy;
    Plane xy;
};

Moments moments_of(const Plane& x, const Plane& y, unsigned threads) {
    std::vector<double> kernel = gaussian(1.5, similarity_window / 2);
    normalize(kernel);
    const auto mean = [&](const Plane& plane) { return filtered(plane, kernel, kernel, threads); };
    return {mean(x), mean(y), mean(product(x, x)), mean(product(y, y)), mean(product(x, y))};
}

double similarity_at(const Moments& moments, int col, int row) {
    constexpr double c1 = 0.01 * 255.0 * 0.01 * 255.0;
    constexpr double c2 = 0.03 * 255.0 * 0.03 * 255.0;
    const double mean_x = moments.x(col, row);
    const double mean_y = moments.y(col, row);
    const double variance_x = moments.xx(col, row) - mean_x * mean_x;
    const double variance_y = moments.yy(col, row) - mean_y * mean_y;
    const double covariance = moments.xy(col, row) - mean_x * mean_y;
    return (mean_x * mean_y + mean_x * mean_y + c1) * (covariance + covariance + c2) /
           ((mean_x * mean_x + mean_y * mean_y + c1) * (variance_x + variance_y + c2));
}

double mean_similarity_inside(const Moments& moments) {
    constexpr int margin = similarity_window / 2;
    const int cols = moments.x.cols() - 2 * margin;
    const int rows = moments.x.rows() - 2 * margin;
    double sum = 0.0;
    for (int row = 0; row < rows; ++row) {
        for (int col = 0; col < cols; ++col) {
            sum += similarity_at(moments, col + margin, row + margin);
        }
    }
    return sum / (static_cast<double>(cols) * rows);
}

bool holds_similarity_window(const Image& picture) {
    return picture.cols() >= similarity_window && picture.rows() >= similarity_window;
}

} // namespace

Result<double> root_mean_square_error(const Image& shown, const Image& truth) {
    if (const auto fit = check_same_size(shown, truth); !fit) {
        return fit.error();
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const Rgba8 a = shown.samples()[i];
        const Rgba8 b = truth.samples()[i];
        sum += squared_difference(a.r, b.r) + squared_difference(a.g, b.g) +
               squared_difference(a.b, b.b);
    }
    return std::sqrt(sum / (3.0 * static_cast<double>(shown.size())));
}

double peak_signal_to_noise(double rmse) {
    return rmse > 0.0 ? -20.0 * std::log10(rmse) : std::numeric_limits<double>::infinity();
}

Result<double> structural_similarity(const Image& shown, const Image& truth, unsigned threads) {
    if (const auto fit = check_same_size(shown, truth); !fit) {
        return fit.error();
    }
    if (!holds_similarity_window(shown)) {
        return Error{fmt::format("SSIM of pictures of {}x{} pixels: {}x{} at least were expected",
                                 shown.cols(), shown.rows(), similarity_window, similarity_window)};
    }
    return mean_similarity_inside(moments_of(luma_of(shown), luma_of(truth), threads));
}

Result<ImageErrors> image_errors(const Image& shown, const Image& truth,
                                 const FlipOptions& options) {
    const auto rmse = root_mean_square_error(shown, truth);
    if (!rmse) {
        return rmse.error();
    }
    ImageErrors errors;
    errors.rmse = *rmse;
    errors.psnr = peak_signal_to_noise(*rmse);
    if (holds_similarity_window(shown)) {
        errors.ssim = structural_similarity(shown, truth, options.threads).value();
    }
    errors.flip = flip(shown, truth, options).value();
    return errors;
}

} // namespace reljef::truth
