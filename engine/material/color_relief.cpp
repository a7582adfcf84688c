#include "engine/material/color_relief.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "engine/material/wrap_mode.h"

namespace reljef::material {
namespace {

// CIE 1976 lightness, up to scale, of the CIE 1931 luminance.
Grid<float> lightness_of(const Image& image) {
    Grid<float> lightness(image.cols(), image.rows());
    std::transform(image.samples().begin(), image.samples().end(), lightness.samples().begin(),
                   [](Rgba8 color) {
                       const glm::vec3 c = linear_from_rgba8(color);
                       return std::cbrt(0.2126F * c.x + 0.7152F * c.y + 0.0722F * c.z);
                   });
    return lightness;
}

// Mirrors at the border: clamping would make a step as wide as the blur.
int mirrored_index(int index, int count) {
    const int period = 2 * count;
    const int inside = ((index % period) + period) % period;
    return inside < count ? inside : period - 1 - inside;
}

int index_outside(int index, int count, bool wraps) {
    return wraps ? index_beyond(index, count, WrapMode::wrap) : mirrored_index(index, count);
}

// Binomial filter along one axis, taps `step` samples apart.
Grid<float> blurred_along(const Grid<float>& values, int step, bool south, bool wraps) {
    constexpr std::array taps{0.0625F, 0.25F, 0.375F, 0.25F, 0.0625F};
    Grid<float> blurred(values.cols(), values.rows());
    for (int row = 0; row < values.rows(); ++row) {
        for (int col = 0; col < values.cols(); ++col) {
            for (int i = 0; i < 5; ++i) {
                const int offset = (i - 2) * step;
                blurred(col, row) +=
                    taps[static_cast<std::size_t>(i)] *
                    values(south ? col : index_outside(col + offset, values.cols(), wraps),
                           south ? index_outside(row + offset, values.rows(), wraps) : row);
            }
        }
    }
    return blurred;
}

// Clips the lowest and the highest hundredth and scales to [0,1].
Grid<float> stretched(Grid<float> heights) {
    std::vector<float> sorted(heights.samples().begin(), heights.samples().end());
    std::sort(sorted.begin(), sorted.end());
    const std::size_t cut = sorted.size() / 100;
    const float low = sorted[cut];
    const float range = sorted[sorted.size() - 1 - cut] - low;
    for (float& height : heights.samples()) {
        height = range > 0.0F ? std::clamp((height - low) / range, 0.0F, 1.0F) : 0.0F;
    }
    return heights;
}

} // namespace

Grid<float> heights_from_colors(const Image& image, const ColorReliefOptions& options) {
    check(options.octaves >= 1 && options.octaves <= 12, "1 to 12 octaves were expected");
    Grid<float> finer = lightness_of(image);
    Grid<float> heights(image.cols(), image.rows());
    const auto samples = finer.samples();
    if (std::all_of(samples.begin(), samples.end(),
                    [&](float value) { return value == samples.front(); })) {
        return heights; // stretching would amplify rounding errors
    }
    for (int octave = 0; octave < options.octaves; ++octave) {
        const int step = 1 << octave; // à trous (Holschneider et al. 1989)
        Grid<float> coarser = blurred_along(blurred_along(finer, step, false, options.wraps), step,
                                            true, options.wraps);
        const float weight = static_cast<float>(step) * (options.dark_is_high ? -1.0F : 1.0F);
        for (std::size_t i = 0; i < heights.size(); ++i) {
            heights.samples()[i] += weight * (finer.samples()[i] - coarser.samples()[i]);
        }
        finer = std::move(coarser);
    }
    return stretched(std::move(heights));
}

} // namespace reljef::material
