#include "engine/cast/lit_levels.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "engine/core/bilinear.h"
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

// Each texel is that of the middle of its area: the mean of four where the sides are even.
Grid<glm::vec3> half_of(const Grid<glm::vec3>& fine) {
    Grid<glm::vec3> coarse(std::max(fine.cols() / 2, 1), std::max(fine.rows() / 2, 1));
    const glm::dvec2 scale(static_cast<double>(fine.cols()) / coarse.cols(),
                           static_cast<double>(fine.rows()) / coarse.rows());
    parallel_for(coarse.rows(), [&](int row) {
        for (int col = 0; col < coarse.cols(); ++col) {
            const glm::dvec2 middle = (glm::dvec2(col, row) + 0.5) * scale - 0.5;
            coarse(col, row) = bilinear(fine, middle, std::identity());
        }
    });
    return coarse;
}

} // namespace

LitLevels::LitLevels(const Image& lit, glm::ivec2 samples) {
    const glm::vec4 coordinate =
        view::texture_from_sample(samples, glm::ivec2(lit.cols(), lit.rows()));
    Grid<glm::vec3> level = linear_texels(lit);
    while (levels_.size() < max_paint_levels) {
        const glm::vec2 texels(level.cols(), level.rows());
        levels_.push_back({texels_.size(),
                           {.stride = level.cols() + 1,
                            .last = texels - 1.0F,
                            .texels_per_sample = glm::vec2(coordinate) * texels,
                            .first = glm::vec2(coordinate.z, coordinate.w) * texels - 0.5F}});
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
}

TilePaint LitLevels::paint(glm::vec2 first_sample) const {
    TilePaint paint;
    paint.level_count = static_cast<int>(levels_.size());
    for (std::size_t i = 0; i < levels_.size(); ++i) {
        PaintLevel& level = paint.levels[i];
        level = levels_[i].paint;
        level.texels = texels_.data() + levels_[i].first;
        level.first += first_sample * level.texels_per_sample;
    }
    return paint;
}

// An anisotropy of at most 8: over a silhouette a pixel's neighbours show other places.
glm::vec2 longest_texels(const view::DrawList& list, const TilePaint& paint, glm::dvec2 spacing) {
    if (list.camera.projection != scene::ProjectionKind::perspective) {
        return {1e6F, 0.0F};
    }
    const glm::dvec2 per_metre = glm::dvec2(paint.levels[0].texels_per_sample) / spacing;
    constexpr double anisotropy = 8.0;
    const double pixel = view::metres_a_pixel(list.camera, list.size).y;
    return {0.0F, static_cast<float>(anisotropy * pixel * std::max(per_metre.x, per_metre.y))};
}

} // namespace reljef::cast
