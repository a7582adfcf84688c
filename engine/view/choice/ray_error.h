#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "engine/scene/graph/camera.h"
#include "engine/scene/streaming/terrain_surface.h"
#include "engine/view/choice/ray_rounding.h"

namespace reljef::view {

/// Bounds the error of `exact` on OpenGL over a plane in memory, which is that of rounding.
class RayError {
public:
    /// `steepness`: steepest(surface). Preconditions: a perspective camera; the surface lies on a
    /// plane, moved by `offset` metres.
    RayError(const scene::Camera& camera, glm::ivec2 size, const scene::TerrainSurface& surface,
             double steepness, glm::dvec3 offset);

    /// The largest error of a hit `distance` metres from the eye or farther, pixels.
    [[nodiscard]] double at(double distance) const;
    /// Whether rays to all of the surface keep an error, pixels: it is so far away.
    [[nodiscard]] bool keeps(double error) const;

private:
    [[nodiscard]] bool is_nearer(double distance, int level, glm::ivec2 block) const;

    const scene::TerrainSurface& surface_;
    glm::dvec3 eye_; // local metres
    RayRounding rounding_;
    RayRounding::Part part_; // steepest and widest
};

} // namespace reljef::view
