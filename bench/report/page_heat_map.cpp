#include "bench/report/page_heat_map.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace reljef::bench {
namespace {

// Hue and colourfulness along the scale: Oklab's a and b at even steps, blue through green to
// yellow, all inside sRGB. Magenta is left for what has no bound.
constexpr std::array<glm::vec2, 5> hues{
    {{0.0F, -0.08F}, {-0.03F, -0.12F}, {-0.09F, -0.02F}, {-0.12F, 0.12F}, {-0.05F, 0.165F}}};
constexpr float darkest = 0.20F;
constexpr float lightest = 0.92F;

constexpr int hatch_period = 8; // pixels
constexpr int hatch_width = 2;
constexpr Rgba8 hatch_line{104, 104, 108, 255};
constexpr Rgba8 hatch_ground{62, 62, 66, 255};

// Ottosson 2020, "A perceptual color space for image processing".
glm::vec3 linear_from_oklab(float lightness, glm::vec2 ab) {
    const glm::vec3 roots = lightness + glm::vec3(0.3963377774F * ab.x + 0.2158037573F * ab.y,
                                                  -0.1055613458F * ab.x - 0.0638541728F * ab.y,
                                                  -0.0894841775F * ab.x - 1.2914855480F * ab.y);
    const glm::vec3 lms = roots * roots * roots;
    return {4.0767416621F * lms.x - 3.3077115913F * lms.y + 0.2309699292F * lms.z,
            -1.2684380046F * lms.x + 2.6097574011F * lms.y - 0.3413193965F * lms.z,
            -0.0041960863F * lms.x - 0.7034186147F * lms.y + 1.7076147010F * lms.z};
}

glm::vec2 hue_at(float share) {
    const float place = share * static_cast<float>(hues.size() - 1);
    const std::size_t index = std::min(static_cast<std::size_t>(place), hues.size() - 2);
    return glm::mix(hues.at(index), hues.at(index + 1), place - static_cast<float>(index));
}

std::size_t level_of(double error_px) {
    const double share = std::log(std::max(error_px, heat_low_px) / heat_low_px) /
                         std::log(heat_high_px / heat_low_px);
    return std::min(static_cast<std::size_t>(share * static_cast<double>(heat_levels)),
                    heat_levels - 1);
}

Rgba8 hatch(int col, int row) {
    return (col + row) % hatch_period < hatch_width ? hatch_line : hatch_ground;
}

} // namespace

std::array<Rgba8, heat_levels> heat_scale() {
    std::array<Rgba8, heat_levels> scale;
    for (std::size_t i = 0; i < scale.size(); ++i) {
        const float share = static_cast<float>(i) / static_cast<float>(scale.size() - 1);
        scale[i] =
            rgba8_from_linear(linear_from_oklab(glm::mix(darkest, lightest, share), hue_at(share)));
    }
    return scale;
}

Image heat_map(const Grid<float>& error_px) {
    const auto scale = heat_scale();
    Image map(error_px.cols(), error_px.rows());
    for (int row = 0; row < map.rows(); ++row) {
        for (int col = 0; col < map.cols(); ++col) {
            const float error = error_px(col, row);
            check(!(error < 0.0F), "heat_map of a negative error");
            map(col, row) = std::isnan(error)   ? hatch(col, row)
                            : std::isinf(error) ? heat_unbounded
                                                : scale.at(level_of(error));
        }
    }
    return map;
}

} // namespace reljef::bench
