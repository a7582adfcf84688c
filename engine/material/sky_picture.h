#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/core/color.h"

namespace reljef::material {

/// What is seen in all directions around an eye: the six faces of a cube, as mip levels.
/// Directions: x east, y north, z up; of any length above 0. Colours are linear.
class SkyPicture {
public:
    static constexpr int face_count = 6; ///< towards +x, −x, +y, −y, +z, −z
    static constexpr int max_side = 2048;
    static constexpr int border = 1;

    /// Faces, one below the other: side + 2 texels wide, with a border that continues them. Across
    /// a face go the other two axes, in their order, each divided by the length of the face's own:
    /// from −1 to 1.
    struct Level {
        int side = 0; ///< texels without the border
        Image faces;
    };
    using ColorAt = std::function<glm::vec3(glm::dvec3 direction)>;

    /// Samples a source, which several threads call. Precondition: `side` in 1..max_side.
    SkyPicture(int side, const ColorAt& color_at);

    /// The finest first.
    [[nodiscard]] std::span<const Level> levels() const { return levels_; }
    /// The level whose texels are about as wide as a pixel.
    [[nodiscard]] std::size_t level_for(double radians_a_pixel) const;
    /// Bilinear.
    [[nodiscard]] glm::vec3 color(glm::dvec3 direction, std::size_t level = 0) const;

    /// The mean colour just above the horizon.
    [[nodiscard]] glm::vec3 horizon() const { return horizon_; }

private:
    std::vector<Level> levels_;
    glm::vec3 horizon_{0.0F};
};

/// How a picture shows all directions: `turn` degrees clockwise from north is its middle.
struct SkyPlacement {
    double turn = 0.0;
    /// Columns are azimuths, rows altitudes: of the whole sphere, or down to the horizon only,
    /// which then goes on below.
    bool is_dome = false;
};

/// From an equirectangular picture. Precondition: not empty.
SkyPicture sky_from_panorama(const Image& whole, const SkyPlacement& placement);

/// Six square pictures, as seen from within: the upright ones in the directions front (north
/// without a turn), right, back and left, one above whose lower side meets the front, and one below
/// whose upper side does.
struct SkyFaces {
    enum Face : std::size_t { front, right, back, left, up, down };
    std::array<Image, SkyPicture::face_count> pictures;
};

/// Precondition: no picture is empty.
SkyPicture sky_from_faces(SkyFaces faces, double turn);

} // namespace reljef::material
