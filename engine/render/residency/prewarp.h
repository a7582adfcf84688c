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

/// Relief texture mapping by forward warping (Oliveira, Bishop and McAllister 2000). Projects a
/// surface point with displacement d onto the reference plane: u' = (u + k1·d)/(1 + k3·d),
/// v' = (v + k2·d)/(1 + k3·d).
class Warp {
public:
    /// `eye` in columns, rows and heights above the plane; w 1: a position, w 0: a direction. An
    /// eye that is not above the plane sees nothing.
    explicit Warp(glm::dvec4 eye);

    /// Empty if the point is not below the eye.
    [[nodiscard]] std::optional<glm::dvec2> at(glm::dvec2 place, double height) const;

    /// Column and row nearest to the eye; infinite for a direction.
    [[nodiscard]] glm::dvec2 nearest() const { return nearest_; }

private:
    bool sees_ = false;
    glm::dvec3 k_{0.0};
    glm::dvec2 nearest_{0.0};
};

glm::dvec4 warp_eye(const scene::Camera& camera, const glm::dmat4& world_from_local);

/// The column and row of the surface that each sample of the reference plane shows; negative if
/// none. `heights` above the plane. Warps the rows, then the columns of the result, with linear
/// interpolation between samples, back to front (McMillan and Bishop 1995). Points that land beyond
/// the border are lost.
Grid<glm::vec2> prewarped(GridView<const float> heights, const Warp& warp,
                          const ParallelOptions& parallel = {});

/// The same for a surface and its flat reference surface: column, row and height in metres.
/// `local_eye`: metres, w as for Warp.
Grid<glm::vec4> warped_places(const scene::TerrainSurface& surface, glm::dvec4 local_eye);

} // namespace reljef::render
