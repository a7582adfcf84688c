#pragma once

#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "engine/core/grid.h"
#include "engine/core/parallel_for.h"
#include "engine/scene/graph/camera.h"
#include "engine/scene/graph/terrain_node.h"

namespace reljef::render {

/// Relief texture mapping by forward warping (Oliveira, Bishop and McAllister 2000): where on the
/// reference plane an eye sees a point of the surface that stands d above it,
/// u' = (u + k1·d)/(1 + k3·d), v' = (v + k2·d)/(1 + k3·d).
class Warp {
public:
    /// `eye` in columns, rows and heights above the plane; w 1: a place, w 0: the direction towards
    /// an eye that is far away. Nothing is seen by an eye that is not above the plane.
    explicit Warp(glm::dvec4 eye);

    /// Nothing where the point is not below the eye.
    [[nodiscard]] std::optional<glm::dvec2> at(glm::dvec2 place, double height) const;

    /// Column and row nearest to the eye; infinite for one that is far away.
    [[nodiscard]] glm::dvec2 nearest() const { return nearest_; }

private:
    bool sees_ = false;
    glm::dvec3 k_{0.0};
    glm::dvec2 nearest_{0.0};
};

/// The eye of a camera as Warp takes it, local metres.
glm::dvec4 warp_eye(const scene::Camera& camera, const glm::dmat4& world_from_local);

/// What each sample of the reference plane shows: the column and row of the surface that is seen
/// there, both negative where it is none. `heights` above the plane. Every row of samples is warped
/// along itself, then every column of the outcome; places and v' between samples are interpolated,
/// and what lies farther from the eye is done first (McMillan and Bishop 1995), so that it is
/// covered. What lands beyond the border is lost.
Grid<glm::vec2> prewarped(GridView<const float> heights, const Warp& warp,
                          const ParallelOptions& parallel = {});

/// The same of a surface over a plane and its flat reference surface: column, row and the height
/// there, metres. `local_eye`: metres, w as of Warp.
Grid<glm::vec4> warped_places(const scene::TerrainSurface& surface, glm::dvec4 local_eye);

} // namespace reljef::render
