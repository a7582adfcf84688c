#include "engine/cast/lit_levels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <span>

#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "engine/core/parallel_for.h"
#include "engine/view/terrain_maps.h"

namespace reljef::cast {
namespace {

// Rounds by cutting off: no value is negative, and std::lround is a call for each channel.
std::uint32_t root_bits(float channel) {
    constexpr float largest = 1023.0F;
    constexpr float half = 0.5F;
    return static_cast<std::uint32_t>(std::sqrt(std::clamp(channel, 0.0F, 1.0F)) * largest + half);
}

// Means of two by two; the last column and row count twice where there is no next one.
template <class T, class Linear>
Grid<glm::vec3> half_of(const Grid<T>& fine, const Linear& linear, unsigned threads) {
    Grid<glm::vec3> coarse((fine.cols() + 1) / 2, (fine.rows() + 1) / 2);
    const auto halve_row = [&](int row) {
        for (int col = 0; col < coarse.cols(); ++col) {
            const glm::ivec2 first(2 * col, 2 * row);
            coarse(col, row) = 0.25F * (linear(fine(first.x, first.y)) +
                                        linear(fine.clamped(first.x + 1, first.y)) +
                                        linear(fine.clamped(first.x, first.y + 1)) +
                                        linear(fine.clamped(first.x + 1, first.y + 1)));
        }
    };
    parallel_for(coarse.rows(), halve_row, {threads, {}, {}});
    return coarse;
}

// A texel more in each row and column repeats the last one.
template <class T, class Pack>
void add_level(const Grid<T>& level, const Pack& pack, unsigned threads,
               std::vector<std::uint32_t>& texels) {
    const std::size_t begin = texels.size();
    const std::size_t pitch = static_cast<std::size_t>(level.cols()) + 1;
    texels.resize(begin + pitch * (static_cast<std::size_t>(level.rows()) + 1));
    const auto pack_row = [&](int row) {
        const auto to =
            std::span(texels).subspan(begin + static_cast<std::size_t>(row) * pitch, pitch);
        const auto from = level.row(std::min(row, level.rows() - 1));
        std::transform(from.begin(), from.end(), to.begin(), std::cref(pack));
        to.back() = to[to.size() - 2];
    };
    parallel_for(level.rows() + 1, pack_row, {threads, {}, {}});
}

class BytePacker {
public:
    BytePacker() {
        for (std::size_t byte = 0; byte < bits_.size(); ++byte) {
            bits_[byte] =
                root_bits(linear_from_rgba8({static_cast<std::uint8_t>(byte), 0, 0, 255}).r);
        }
    }
    std::uint32_t operator()(Rgba8 texel) const {
        return bits_[texel.r] | bits_[texel.g] << 10U | bits_[texel.b] << 20U;
    }

private:
    std::array<std::uint32_t, 256> bits_{};
};

glm::vec3 same(glm::vec3 texel) {
    return texel;
}

} // namespace

std::uint32_t packed_roots(glm::vec3 linear) {
    return root_bits(linear.r) | root_bits(linear.g) << 10U | root_bits(linear.b) << 20U;
}

std::uint32_t packed_normal(glm::vec3 normal) {
    const auto bits = [](float component) {
        const float inside = std::clamp(component, -1.0F, 1.0F);
        return static_cast<std::uint32_t>(std::lround(inside * normal_zero) + normal_zero);
    };
    return bits(normal.x) | bits(normal.y) << 10U | bits(normal.z) << 20U;
}

LitLevels::LitLevels(const Image& lit, glm::ivec2 samples, unsigned threads) {
    static const BytePacker pack;
    place({lit.cols(), lit.rows()}, samples);
    add_level(lit, pack, threads, texels_);
    if (lit.size() > 1) {
        add_coarse_levels(half_of(lit, linear_from_rgba8, threads), packed_roots, threads);
    }
    repeat_last_level();
}

LitLevels::LitLevels(const Grid<glm::vec3>& normals, glm::ivec2 samples, unsigned threads) {
    place({normals.cols(), normals.rows()}, samples);
    add_level(normals, packed_normal, threads, texels_);
    if (normals.size() > 1) {
        add_coarse_levels(half_of(normals, same, threads), packed_normal, threads);
    }
    repeat_last_level();
}

void LitLevels::place(glm::ivec2 size, glm::ivec2 samples) {
    const glm::vec4 coordinate = view::texture_from_sample(samples, size);
    paint_.last = size - 1;
    paint_.texels_per_sample = glm::vec2(coordinate) * glm::vec2(size);
    paint_.first = glm::vec2(coordinate.z, coordinate.w) * glm::vec2(size) - 0.5F;
    paint_.level_count = 1;
    constexpr std::size_t for_borders = 3; // each level has a row and a column more
    const glm::ivec2 sides = size + 1;
    texels_.reserve(static_cast<std::size_t>(sides.x) * static_cast<std::size_t>(sides.y) * 4 / 3 +
                    for_borders * static_cast<std::size_t>(sides.x + sides.y));
}

void LitLevels::repeat_last_level() {
    const auto last = static_cast<std::size_t>(paint_.level_count) - 1;
    std::fill(paint_.begin.begin() + paint_.level_count, paint_.begin.end(), paint_.begin[last]);
}

template <class Pack>
void LitLevels::add_coarse_levels(Grid<glm::vec3> level, const Pack& pack, unsigned threads) {
    while (true) {
        paint_.begin.at(static_cast<std::size_t>(paint_.level_count++)) =
            static_cast<std::int32_t>(texels_.size());
        add_level(level, pack, threads, texels_);
        if (level.size() == 1 ||
            static_cast<std::size_t>(paint_.level_count) == paint_.begin.size()) {
            return;
        }
        level = half_of(level, same, threads);
    }
}

TilePaint LitLevels::paint(glm::vec2 first_sample) const {
    TilePaint paint = paint_;
    paint.texels = texels_.data();
    paint.first += first_sample * paint.texels_per_sample;
    return paint;
}

// An anisotropy of at most 8: over a silhouette a pixel's neighbours show other places.
glm::vec2 longest_texels(const view::DrawList& list, const TilePaint& paint, glm::dvec2 spacing) {
    const glm::dvec2 per_metre = glm::dvec2(paint.texels_per_sample) / spacing;
    constexpr double anisotropy = 8.0;
    // By the larger side of a texel: near poles the other one would blur over dozens of pixels.
    const double texels = anisotropy * std::min(per_metre.x, per_metre.y);
    return glm::vec2(texels * glm::dvec2(scene::metres_a_pixel(list.camera, list.size)));
}

} // namespace reljef::cast
