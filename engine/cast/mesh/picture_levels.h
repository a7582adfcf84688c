#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/color.h"
#include "engine/core/grid.h"
#include "engine/core/parallel_for.h"

namespace reljef::cast {

/// Half as many columns and rows, at least 1: means over areas, each of as many fine values as the
/// ratio of the sides. `value`: of a fine one. Precondition: not empty.
template <class T, class Value>
Grid<glm::vec3> half_as_large(const Grid<T>& fine, const Value& value) {
    Grid<glm::vec3> coarse(std::max(fine.cols() / 2, 1), std::max(fine.rows() / 2, 1));
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
                sum += weight * value(fine(x, y));
                weights += weight;
            }
        }
        coarse(col, row) = sum / weights;
    });
    return coarse;
}

/// A picture that repeats over a mesh, and its mip levels, each half as large.
class PictureLevels {
public:
    /// Precondition: not empty.
    explicit PictureLevels(const Image& picture);

    /// Linear colour at a texture coordinate: bilinear in the two nearest levels. `right`, `down`:
    /// changes of the coordinate to the next pixels; an anisotropy of 8 is kept, as in the shaders.
    [[nodiscard]] glm::vec3 at(glm::dvec2 coordinate, glm::dvec2 right, glm::dvec2 down) const;

private:
    [[nodiscard]] glm::vec3 at_level(std::size_t level, glm::dvec2 coordinate) const;

    std::vector<Image> levels_;
};

} // namespace reljef::cast
