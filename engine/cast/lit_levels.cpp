#include "engine/cast/lit_levels.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "engine/core/parallel_for.h"
#include "engine/view/terrain_maps.h"

namespace reljef::cast {
namespace {

std::uint32_t packed(glm::vec3 linear) {
    const auto bits = [](float channel) {
        constexpr float largest = 1023.0F;
        return static_cast<std::uint32_t>(
            std::lround(std::sqrt(std::clamp(channel, 0.0F, 1.0F)) * largest));
    };
    return bits(linear.r) | bits(linear.g) << 10U | bits(linear.b) << 20U;
}

Grid<glm::vec3> linear_texels(const Image& lit) {
    Grid<glm::vec3> texels(lit.cols(), lit.rows());
    std::transform(lit.samples().begin(), lit.samples().end(), texels.samples().begin(),
                   linear_from_rgba8);
    return texels;
}

// Means of two by two; the last column and row count twice where there is no next one.
Grid<glm::vec3> half_of(const Grid<glm::vec3>& fine) {
    Grid<glm::vec3> coarse((fine.cols() + 1) / 2, (fine.rows() + 1) / 2);
    parallel_for(coarse.rows(), [&](int row) {
        for (int col = 0; col < coarse.cols(); ++col) {
            const glm::ivec2 first(2 * col, 2 * row);
            coarse(col, row) =
                0.25F *
                (fine(first.x, first.y) + fine.clamped(first.x + 1, first.y) +
                 fine.clamped(first.x, first.y + 1) + fine.clamped(first.x + 1, first.y + 1));
        }
    });
    return coarse;
}

} // namespace

LitLevels::LitLevels(const Image& lit, glm::ivec2 samples) {
    const glm::ivec2 size(lit.cols(), lit.rows());
    const glm::vec4 coordinate = view::texture_from_sample(samples, size);
    paint_.last = size - 1;
    paint_.texels_per_sample = glm::vec2(coordinate) * glm::vec2(size);
    paint_.first = glm::vec2(coordinate.z, coordinate.w) * glm::vec2(size) - 0.5F;
    Grid<glm::vec3> level = linear_texels(lit);
    for (std::int32_t& begin : paint_.begin) {
        begin = static_cast<std::int32_t>(texels_.size());
        ++paint_.level_count;
        for (int row = 0; row <= level.rows(); ++row) {
            for (int col = 0; col <= level.cols(); ++col) {
                texels_.push_back(packed(level.clamped(col, row)));
            }
        }
        if (level.size() == 1) {
            break;
        }
        level = half_of(level);
    }
    const auto last = static_cast<std::size_t>(paint_.level_count) - 1;
    std::fill(paint_.begin.begin() + paint_.level_count, paint_.begin.end(), paint_.begin[last]);
}

TilePaint LitLevels::paint(glm::vec2 first_sample) const {
    TilePaint paint = paint_;
    paint.texels = texels_.data();
    paint.first += first_sample * paint.texels_per_sample;
    return paint;
}

// An anisotropy of at most 8: over a silhouette a pixel's neighbours show other places.
glm::vec2 longest_texels(const view::DrawList& list, const TilePaint& paint, glm::dvec2 spacing) {
    if (list.camera.projection != scene::ProjectionKind::perspective) {
        return {1e6F, 0.0F};
    }
    const glm::dvec2 per_metre = glm::dvec2(paint.texels_per_sample) / spacing;
    constexpr double anisotropy = 8.0;
    const double pixel = view::metres_a_pixel(list.camera, list.size).y;
    return {0.0F, static_cast<float>(anisotropy * pixel * std::max(per_metre.x, per_metre.y))};
}

} // namespace reljef::cast
