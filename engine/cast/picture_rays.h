#pragma once

#include <array>

#include <glm/common.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/geometry.h"
#include "engine/scene/graph/camera.h"
#include "engine/terrain/field/placement.h"

namespace reljef::cast {

/// The rays of a picture in sample coordinates (col, row, height in true metres). They are linear
/// in the place on the picture; over the curved Earth, of second degree. Their t is the depth along
/// the view axis.
struct PictureRays {
    /// A ray, and its changes for a pixel to the right and a pixel down.
    struct Vectors {
        glm::dvec3 first{0.0}; ///< at the top left corner of the picture
        glm::dvec3 right{0.0};
        glm::dvec3 down{0.0};
        /// Factors of right², right · down and down², pixels: 0 where rays are linear.
        std::array<glm::dvec3, 3> bends{};

        [[nodiscard]] glm::dvec3 at(glm::dvec2 pixel) const {
            return first + pixel.x * right + pixel.y * down + pixel.x * pixel.x * bends[0] +
                   pixel.x * pixel.y * bends[1] + pixel.y * pixel.y * bends[2];
        }
        /// What linear vectors miss at most over a rectangle of a size in pixels, if they are as
        /// right at its corners as a plane can be.
        [[nodiscard]] glm::dvec3 bulge(glm::dvec2 extent) const {
            return 0.25 * (extent.x * extent.x * glm::abs(bends[0]) +
                           extent.x * extent.y * glm::abs(bends[1]) +
                           extent.y * extent.y * glm::abs(bends[2]));
        }
        [[nodiscard]] bool is_bent() const { return bends != std::array<glm::dvec3, 3>{}; }
    };

    glm::ivec2 size{0}; ///< of the picture, pixels
    Vectors origin;     ///< constant in perspective
    Vectors direction;  ///< constant on a map
    Interval range;     ///< of t
    double anchor =
        0.0; ///< t before which no ray is over `bounds`; the rays are precise from there
};

/// The rays of a camera over a terrain on a plane. `bounds`: of the surface, in samples. Map
/// cameras have a fitted depth (scene::with_fitted_depth). Preconditions: an invertible transform,
/// a plane placement.
PictureRays picture_rays(const scene::Camera& camera, glm::ivec2 size,
                         const glm::dmat4& world_from_local, const terrain::Placement& placement,
                         const Box& bounds);

/// The same in local coordinates, metres. `bounds`: of the surface, in these.
PictureRays local_rays(const scene::Camera& camera, glm::ivec2 size,
                       const glm::dmat4& world_from_local, const Box& bounds);

/// A direction in samples (col, row, true metres) from one in local coordinates. Precondition: a
/// plane placement.
glm::dvec3 direction_in_samples(const terrain::Placement& placement, glm::dvec3 local);

/// Depth along the view axis at which the rays meet the nearest and the farthest place of a box in
/// their coordinates.
Interval depths_of(const Box& bounds, const PictureRays& rays, bool is_perspective);

/// The places of rays at a depth.
PictureRays::Vectors places_at(const PictureRays& rays, double t);

/// The rays of `like` between two depths, but straight from place to place.
PictureRays straight_between(const PictureRays::Vectors& from, const PictureRays::Vectors& to,
                             Interval depths, const PictureRays& like);

/// Linear rays that are near those of a rectangle of `size` pixels at `first`: off by half of the
/// bulge at most, in the middle and at the corners.
PictureRays made_linear(PictureRays rays, glm::ivec2 first, glm::ivec2 size);

/// The rays in samples that are `scale` times those of `rays`, plus `by`.
PictureRays in_samples(PictureRays rays, glm::dvec2 scale, glm::dvec2 by);

} // namespace reljef::cast
