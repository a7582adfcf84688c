#include "engine/core/color.h"

#include <array>
#include <bit>
#include <cmath>
#include <limits>

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

// The smallest float in [0, 1] that encodes to at least `byte`. Encoding is monotonic.
float min_linear_of(int byte) {
    std::uint32_t low = 0; // bit patterns of non-negative floats are ordered like their values
    std::uint32_t high = std::bit_cast<std::uint32_t>(1.0F);
    while (low < high) {
        const std::uint32_t middle = low + (high - low) / 2;
        if (byte_from_unit(srgb_from_linear(std::bit_cast<float>(middle))) >= byte) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    return std::bit_cast<float>(low);
}

// Table lookup with the same bytes as the formula, twenty times faster than its power.
class SrgbBytes {
public:
    SrgbBytes() {
        for (std::size_t byte = 0; byte < byte_count; ++byte) {
            min_linear_[byte] = min_linear_of(static_cast<int>(byte));
        }
        min_linear_[byte_count] = std::numeric_limits<float>::infinity();
        for (std::size_t i = 0; i < first_.size(); ++i) {
            first_[i] = byte_from_unit(srgb_from_linear(static_cast<float>(i) / steps));
        }
    }
    [[nodiscard]] std::uint8_t of(float linear) const {
        if (!(linear > 0.0F)) {
            return 0;
        }
        if (linear >= 1.0F) {
            return 255;
        }
        const std::uint8_t byte = first_[static_cast<std::size_t>(linear * steps)];
        const bool is_next = linear >= min_linear_[byte + 1U];
        return static_cast<std::uint8_t>(byte + (is_next ? 1 : 0));
    }

private:
    static constexpr std::size_t byte_count = 256;
    // A step has one border between bytes at most: they are 1/(12.92 · 255) apart near 0, and more
    // elsewhere.
    static constexpr float steps = 4096.0F;
    static_assert(steps > 12.92F * 255.0F);
    std::array<float, byte_count + 1> min_linear_{};
    std::array<std::uint8_t, 4096> first_{};
};

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
    static const SrgbBytes bytes;
    return {bytes.of(linear.r), bytes.of(linear.g), bytes.of(linear.b), alpha};
}

glm::vec3 linear_from_rgba8(Rgba8 color) {
    static const std::array<float, 256> linear = linear_values();
    return {linear[color.r], linear[color.g], linear[color.b]};
}

} // namespace reljef
