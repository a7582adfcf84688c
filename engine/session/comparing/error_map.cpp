#include "engine/session/comparing/error_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include "engine/core/check.h"

namespace reljef::session {
namespace {

// Dark to light, as steps of the logarithm.
constexpr std::array ramp{glm::vec3(74.0F, 40.0F, 130.0F), glm::vec3(176.0F, 52.0F, 112.0F),
                          glm::vec3(236.0F, 104.0F, 50.0F), glm::vec3(252.0F, 180.0F, 40.0F),
                          glm::vec3(255.0F, 250.0F, 170.0F)};

Rgba8 rounded(glm::vec3 color) {
    const glm::vec3 half = color + 0.5F;
    return {static_cast<std::uint8_t>(half.x), static_cast<std::uint8_t>(half.y),
            static_cast<std::uint8_t>(half.z), 255};
}

glm::vec3 floats(Rgba8 color) {
    return {color.r, color.g, color.b};
}

// The luma (ITU-R BT.601), darker, so that colours stand out.
glm::vec3 dark_grey(Rgba8 color) {
    constexpr float darkness = 0.5F;
    return glm::vec3(darkness *
                     (0.299F * static_cast<float>(color.r) + 0.587F * static_cast<float>(color.g) +
                      0.114F * static_cast<float>(color.b)));
}

Rgba8 mapped(const truth::GeometricErrors& errors, glm::ivec2 pixel, Rgba8 truth) {
    constexpr float of_error = 0.8F; // weight beside the grey picture, so that forms can be seen
    const truth::Verdict verdict = errors.verdicts(pixel.x, pixel.y);
    if (verdict == truth::Verdict::hole) {
        return hole_color;
    }
    const glm::vec3 grey = dark_grey(truth);
    const float error = errors.reprojection.map(pixel.x, pixel.y);
    if (std::isnan(error)) {
        return rounded(grey);
    }
    const bool is_beside_terrain =
        verdict == truth::Verdict::wrong && std::isnan(errors.hit.map(pixel.x, pixel.y));
    if (is_beside_terrain || std::isinf(error)) {
        return unbounded_color;
    }
    if (error >= static_cast<float>(min_mapped_error)) {
        return rounded(glm::mix(grey, floats(error_color(error)), of_error));
    }
    return verdict == truth::Verdict::wrong ? wrong_color : rounded(grey);
}

} // namespace

Rgba8 error_color(double pixels) {
    const double decades = std::log10(max_mapped_error / min_mapped_error);
    const double share = std::clamp(
        std::log10(std::max(pixels, min_mapped_error) / min_mapped_error) / decades, 0.0, 1.0);
    const double place = share * static_cast<double>(ramp.size() - 1);
    const auto below = std::min(static_cast<std::size_t>(place), ramp.size() - 2);
    return rounded(glm::mix(ramp.at(below), ramp.at(below + 1),
                            static_cast<float>(place - static_cast<double>(below))));
}

Image error_map(const truth::GeometricErrors& errors, const Image& truth) {
    reljef::check(errors.verdicts.cols() == truth.cols() && errors.verdicts.rows() == truth.rows(),
                  "errors of a picture of the same size were expected");
    Image map(truth.cols(), truth.rows());
    for (int row = 0; row < truth.rows(); ++row) {
        for (int col = 0; col < truth.cols(); ++col) {
            map(col, row) = mapped(errors, {col, row}, truth(col, row));
        }
    }
    return map;
}

} // namespace reljef::session
