#include "engine/cast/mesh/picture_levels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/core/parallel_for.h"

namespace reljef::cast {
namespace {

// Means over areas: each coarse texel covers as many fine ones as the sides' ratio says.
Image halved(const Image& fine) {
    Image coarse(std::max(fine.cols() / 2, 1), std::max(fine.rows() / 2, 1));
    const glm::dvec2 size =
        glm::dvec2(fine.cols(), fine.rows()) / glm::dvec2(coarse.cols(), coarse.rows());
    for_each_cell(coarse.cols(), coarse.rows(), {}, [&](int col, int row) {
        const glm::dvec2 begin = size * glm::dvec2(col, row);
        const glm::dvec2 end = begin + size;
        const glm::ivec2 first(glm::floor(begin));
        const glm::ivec2 last = glm::min(glm::ivec2(glm::ceil(end)), {fine.cols(), fine.rows()});
        glm::vec3 sum(0.0F);
        float weights = 0.0F;
        for (int y = first.y; y < last.y; ++y) {
            for (int x = first.x; x < last.x; ++x) {
                const glm::dvec2 low = glm::max(begin, glm::dvec2(x, y));
                const glm::dvec2 covered = glm::min(end, glm::dvec2(x + 1, y + 1)) - low;
                const auto weight = static_cast<float>(std::max(covered.x * covered.y, 0.0));
                sum += weight * linear_from_rgba8(fine(x, y));
                weights += weight;
            }
        }
        coarse(col, row) = rgba8_from_linear(sum / weights);
    });
    return coarse;
}

double level_of(glm::dvec2 size, glm::dvec2 right, glm::dvec2 down) {
    const glm::dvec2 across = right * size;
    const glm::dvec2 along = down * size;
    const double a = glm::dot(across, across);
    const double b = glm::dot(along, along);
    constexpr double anisotropy = 8.0;
    const double square =
        std::min(std::max(a, b), anisotropy * anisotropy * std::max(std::min(a, b), 1e-12));
    return square > 1.0 ? 0.5 * std::log2(square) : 0.0;
}

} // namespace

PictureLevels::PictureLevels(const Image& picture) : levels_{picture} {
    while (levels_.back().size() > 1) {
        levels_.push_back(halved(levels_.back()));
    }
}

glm::vec3 PictureLevels::at_level(std::size_t level, glm::dvec2 coordinate) const {
    const Image& picture = levels_[level];
    const glm::ivec2 size(picture.cols(), picture.rows());
    const glm::dvec2 place = (coordinate - glm::floor(coordinate)) * glm::dvec2(size) - 0.5;
    const glm::ivec2 near(glm::floor(place));
    const glm::vec2 part(place - glm::dvec2(near));
    const auto texel = [&](int col, int row) {
        return linear_from_rgba8(
            picture((near.x + col + size.x) % size.x, (near.y + row + size.y) % size.y));
    };
    return glm::mix(glm::mix(texel(0, 0), texel(1, 0), part.x),
                    glm::mix(texel(0, 1), texel(1, 1), part.x), part.y);
}

glm::vec3 PictureLevels::at(glm::dvec2 coordinate, glm::dvec2 right, glm::dvec2 down) const {
    const double last = static_cast<double>(levels_.size()) - 1.0;
    const glm::dvec2 size(levels_.front().cols(), levels_.front().rows());
    const double level = std::min(level_of(size, right, down), last);
    const auto fine = static_cast<std::size_t>(level);
    const auto part = static_cast<float>(level - static_cast<double>(fine));
    const glm::vec3 color = at_level(fine, coordinate);
    return part > 0.0F ? glm::mix(color, at_level(fine + 1, coordinate), part) : color;
}

} // namespace reljef::cast
