#pragma once

#include <memory>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/color.h"

namespace reljef::cast {

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
