#include "engine/terrain/field/tint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <glm/common.hpp>

namespace reljef::terrain {
namespace {

struct Stop {
    float at;        // share of the height range
    glm::vec3 color; // sRGB, 0..255
};

// Imhof's tints, darkened to the albedo of ground.
constexpr std::array<Stop, 7> scale{{{0.00F, {94.0F, 123.0F, 81.0F}},
                                     {0.15F, {119.0F, 139.0F, 91.0F}},
                                     {0.32F, {159.0F, 159.0F, 111.0F}},
                                     {0.50F, {160.0F, 139.0F, 97.0F}},
                                     {0.68F, {133.0F, 106.0F, 77.0F}},
                                     {0.84F, {141.0F, 133.0F, 126.0F}},
                                     {1.00F, {205.0F, 205.0F, 207.0F}}}};

Rgba8 rgba8(glm::vec3 color) {
    const glm::vec3 rounded = glm::clamp(color + 0.5F, glm::vec3(0.0F), glm::vec3(255.0F));
    return {static_cast<std::uint8_t>(rounded.r), static_cast<std::uint8_t>(rounded.g),
            static_cast<std::uint8_t>(rounded.b), 255};
}

Rgba8 tint(float share) {
    const auto* upper = std::find_if(scale.begin() + 1, scale.end() - 1,
                                     [&](const Stop& stop) { return share < stop.at; });
    const Stop& lower = *(upper - 1);
    const float t = std::clamp((share - lower.at) / (upper->at - lower.at), 0.0F, 1.0F);
    return rgba8(glm::mix(lower.color, upper->color, t));
}

// About 2^16 evenly spread samples that are no voids.
std::vector<float> some_heights(const Heightfield& heightfield) {
    const auto heights = heightfield.heights.samples();
    const auto voids = heightfield.void_mask.samples();
    const auto void_count = static_cast<std::size_t>(
        std::count_if(voids.begin(), voids.end(), [](auto v) { return v != 0; }));
    const std::size_t step = std::max<std::size_t>(1, (heights.size() - void_count) >> 16U);
    std::vector<float> picked;
    std::size_t seen = 0;
    for (std::size_t i = 0; i < heights.size(); ++i) {
        if ((voids.empty() || voids[i] == 0) && seen++ % step == 0) {
            picked.push_back(heights[i]);
        }
    }
    return picked;
}

HeightRange percentiles(const Heightfield& heightfield, double low, double high) {
    std::vector<float> picked = some_heights(heightfield);
    if (picked.empty()) {
        return heightfield.range;
    }
    const auto at = [&](double share) {
        const auto nth = picked.begin() + static_cast<std::ptrdiff_t>(
                                              share * static_cast<double>(picked.size() - 1));
        std::nth_element(picked.begin(), nth, picked.end());
        return static_cast<double>(*nth);
    };
    return {at(low), at(high)};
}

bool is_level_sea(const Heightfield& heightfield, int col, int row) {
    const auto& heights = heightfield.heights;
    for (int r = row - 1; r <= row + 1; ++r) {
        for (int c = col - 1; c <= col + 1; ++c) {
            if (heights.clamped(c, r) != 0.0F) {
                return false;
            }
        }
    }
    return true;
}

glm::vec3 vector_from(Rgba8 color) {
    return {color.r, color.g, color.b};
}

// The pixel of `beneath` at the place of a pixel of `over`. Both images cover the same ground.
Rgba8 nearest(const Image& beneath, const Image& over, int col, int row) {
    const auto scaled = [](int index, int from, int to) {
        return from > 1 ? static_cast<int>(
                              std::lround(static_cast<double>(index) * (to - 1) / (from - 1)))
                        : 0;
    };
    return beneath(scaled(col, over.cols(), beneath.cols()),
                   scaled(row, over.rows(), beneath.rows()));
}

} // namespace

HeightTint::HeightTint(const Heightfield& heightfield)
    : range_(percentiles(heightfield, 0.01, 0.99)) {}

Rgba8 HeightTint::at(double height) const {
    const double extent = range_.high - range_.low;
    return tint(extent > 0.0 ? static_cast<float>((height - range_.low) / extent) : 0.3F);
}

Image hypsometric_tint(const Heightfield& heightfield) {
    const auto& heights = heightfield.heights;
    const HeightTint tint(heightfield);
    Image image(heights.cols(), heights.rows());
    for (int row = 0; row < image.rows(); ++row) {
        for (int col = 0; col < image.cols(); ++col) {
            const bool is_void =
                !heightfield.void_mask.empty() && heightfield.void_mask(col, row) != 0;
            image(col, row) = is_void                               ? HeightTint::no_data
                              : is_level_sea(heightfield, col, row) ? HeightTint::water
                                                                    : tint.at(heights(col, row));
        }
    }
    return image;
}

Image composite(const Image& color, const Image& beneath) {
    if (color.empty()) {
        return beneath;
    }
    Image result = color;
    for (int row = 0; row < result.rows(); ++row) {
        for (int col = 0; col < result.cols(); ++col) {
            Rgba8& pixel = result(col, row);
            if (pixel.a < 255) {
                const glm::vec3 under = vector_from(nearest(beneath, color, col, row));
                pixel = rgba8(
                    glm::mix(under, vector_from(pixel), static_cast<float>(pixel.a) / 255.0F));
            }
        }
    }
    return result;
}

} // namespace reljef::terrain
