#include "engine/cast/mesh/picture_levels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace reljef::cast {
namespace {

Image halved(const Image& fine) {
    const Grid<glm::vec3> means = half_as_large(fine, linear_from_rgba8);
    Image coarse(means.cols(), means.rows());
    std::transform(means.samples().begin(), means.samples().end(), coarse.samples().begin(),
                   [](glm::vec3 mean) { return rgba8_from_linear(mean); });
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
