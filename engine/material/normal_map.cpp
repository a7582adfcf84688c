#include "engine/material/normal_map.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/core/parallel_for.h"

namespace reljef::material {
namespace {

// Rise per sample along the columns (east) and the rows (south), from the 3×3 around a sample: the
// middle line's central difference, or a part of it and of the lines beside it.
glm::dvec2 rise_by(GridView<const float> heights, int col, int row, const NormalOptions& options) {
    const auto at = [&](int east, int south) -> double {
        return heights(index_beyond(col + east, heights.cols(), options.border),
                       index_beyond(row + south, heights.rows(), options.border));
    };
    const double beside = options.filter == NormalFilter::sobel ? 0.25 : 0.0;
    glm::dvec2 rise(0.0);
    for (int line = -1; line <= 1; ++line) {
        const double weight = 0.5 * (line == 0 ? 1.0 - 2.0 * beside : beside);
        rise.x += weight * (at(1, line) - at(-1, line));
        rise.y += weight * (at(line, 1) - at(line, -1));
    }
    return rise;
}

// Rows run south, y runs north.
glm::dvec3 normal_of(glm::dvec2 rise, glm::dvec2 spacing) {
    return glm::normalize(glm::dvec3(-rise.x / spacing.x, rise.y / spacing.y, 1.0));
}

std::uint8_t byte_of(float share) {
    return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(share, 0.0F, 1.0F)));
}

glm::vec3 vector_of(Rgba8 color) {
    return glm::vec3(color.r, color.g, color.b) * (2.0F / 255.0F) - 1.0F;
}

} // namespace

Grid<glm::vec3> normals_from_heights(GridView<const float> heights, const NormalOptions& options) {
    check(!heights.empty(), "normals of no heights");
    Grid<glm::vec3> normals(heights.cols(), heights.rows());
    parallel_for(heights.rows(), [&](int row) {
        for (int col = 0; col < heights.cols(); ++col) {
            normals(col, row) =
                glm::vec3(normal_of(rise_by(heights, col, row, options), options.spacing));
        }
    });
    return normals;
}

glm::dvec3 bilinear_normal(GridView<const float> heights, glm::dvec2 place, glm::dvec2 spacing) {
    check(heights.cols() >= 2 && heights.rows() >= 2, "a bilinear normal needs 2x2 samples");
    const int col = std::clamp(static_cast<int>(place.x), 0, heights.cols() - 2);
    const int row = std::clamp(static_cast<int>(place.y), 0, heights.rows() - 2);
    const auto at = [&](int c, int r) -> double { return heights(col + c, row + r); };
    const glm::dvec2 part = place - glm::dvec2(col, row);
    const glm::dvec2 rise(glm::mix(at(1, 0) - at(0, 0), at(1, 1) - at(0, 1), part.y),
                          glm::mix(at(0, 1) - at(0, 0), at(1, 1) - at(1, 0), part.x));
    return normal_of(rise, spacing);
}

Image normal_image(GridView<const glm::vec3> normals, GridView<const float> unit_heights) {
    check(unit_heights.empty() ||
              (unit_heights.cols() == normals.cols() && unit_heights.rows() == normals.rows()),
          "normals and heights of different sizes");
    Image image(normals.cols(), normals.rows());
    for (int row = 0; row < image.rows(); ++row) {
        for (int col = 0; col < image.cols(); ++col) {
            const glm::vec3 color = 0.5F * normals(col, row) + 0.5F;
            image(col, row) = {byte_of(color.x), byte_of(color.y), byte_of(color.z),
                               unit_heights.empty() ? std::uint8_t{255}
                                                    : byte_of(unit_heights(col, row))};
        }
    }
    return image;
}

ReadNormals normals_from_image(const Image& image) {
    ReadNormals read{Grid<glm::vec3>(image.cols(), image.rows(), {0.0F, 0.0F, 1.0F}), 0};
    for (std::size_t i = 0; i < image.size(); ++i) {
        const glm::vec3 normal = vector_of(image.samples()[i]);
        if (normal.z > 0.0F) {
            read.normals.samples()[i] = glm::normalize(normal);
        } else {
            ++read.unusable;
        }
    }
    return read;
}

} // namespace reljef::material
