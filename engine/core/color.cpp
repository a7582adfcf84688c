#include "engine/core/color.h"

#include <array>
#include <cmath>

namespace reljef {
namespace {

std::uint8_t byte_from_unit(float unit) {
    return static_cast<std::uint8_t>(std::lround(unit * 255.0F));
}

std::array<float, 256> linear_values() {
    std::array<float, 256> values{};
    for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] = linear_from_srgb(static_cast<float>(i) / 255.0F);
    }
    return values;
}

} // namespace

float srgb_from_linear(float linear) {
    if (!(linear > 0.0F)) {
        return 0.0F;
    }
    if (linear >= 1.0F) {
        return 1.0F;
    }
    return linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(linear, 1.0F / 2.4F) - 0.055F;
}

float linear_from_srgb(float encoded) {
    return encoded <= 0.04045F ? encoded / 12.92F : std::pow((encoded + 0.055F) / 1.055F, 2.4F);
}

Rgba8 rgba8_from_linear(glm::vec3 linear, std::uint8_t alpha) {
    return {byte_from_unit(srgb_from_linear(linear.r)), byte_from_unit(srgb_from_linear(linear.g)),
            byte_from_unit(srgb_from_linear(linear.b)), alpha};
}

glm::vec3 linear_from_rgba8(Rgba8 color) {
    static const std::array<float, 256> linear = linear_values();
    return {linear[color.r], linear[color.g], linear[color.b]};
}

} // namespace reljef
