#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/geometry.h"
#include "engine/scene/graph/camera.h"
#include "engine/terrain/field/placement.h"

namespace reljef::cast {

/// The rays of a picture in sample coordinates (col, row, height in true metres). They are linear
/// in the place on the picture, and their t is the depth along the view axis.
struct PictureRays {
    /// A ray, and its changes for a pixel to the right and a pixel down.
    struct Vectors {
        glm::dvec3 first{0.0}; ///< at the top left corner of the picture
        glm::dvec3 right{0.0};
        glm::dvec3 down{0.0};

        [[nodiscard]] glm::dvec3 at(glm::dvec2 pixel) const {
            return first + pixel.x * right + pixel.y * down;
        }
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

/// The rays in samples that are `scale` times those of `rays`, plus `by`.
PictureRays in_samples(PictureRays rays, glm::dvec2 scale, glm::dvec2 by);

} // namespace reljef::cast
