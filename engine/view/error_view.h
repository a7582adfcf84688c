#pragma once

#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "engine/core/geometry.h"
#include "engine/scene/graph/camera.h"
#include "engine/scene/technique/technique.h"
#include "engine/terrain/field/horizon.h"
#include "engine/terrain/field/placement.h"
#include "engine/terrain/mesh/bisection_mesh.h"

namespace reljef::view {

/// Steps per pixel of the grid to which rasterizers snap vertices, in practice.
inline constexpr float vertex_steps = 256.0F;
/// The rasterizer's part of the error, pixels: half the diagonal of a step, and as much again for
/// interpolation in floats.
inline constexpr double rasterizer_error = 1.5 / 256.0;

/// Smallest and largest allowed error bound, pixels.
inline constexpr double min_error = scene::min_polygons_error;
inline constexpr double max_error = scene::max_polygons_error;

/// See terrain::ErrorView::morph_from. A smaller share takes more triangles, a larger one moves
/// vertices faster.
inline constexpr double morph_from = 0.5;

/// How a picture of `size` pixels shows displacements of a terrain placed as `kind` in a node: at
/// most `max_error` pixels, the rasterizer's error included. Preconditions: max_error >
/// rasterizer_error, world_from_local is affine.
terrain::ErrorView error_view(const scene::Camera& camera, glm::ivec2 size,
                              const glm::dmat4& world_from_local, terrain::PlacementKind kind,
                              double max_error);

/// How far errors of a terrain move the pixels that show it.
class PictureError {
public:
    /// As error_view().
    PictureError(const scene::Camera& camera, glm::ivec2 size, const glm::dmat4& world_from_local,
                 terrain::PlacementKind kind);

    /// Upper bound for visible places in a box, pixels, without the rasterizer's error. Each place
    /// is off by at most `error` scene metres along the vertical; the box (local metres) contains
    /// what is drawn. Infinite if the box reaches the eye.
    [[nodiscard]] double in_box(const Box& box, double error) const;

private:
    terrain::ErrorView view_;
    glm::dmat4 world_from_local_;
    glm::dvec3 eye_;
    double near_;
    double corner_angle_; // from the middle of the picture, radians
    bool is_vertical_;
};

/// The view for a horizon in a terrain's local frame, if pixels may be off by `error` pixels. Empty
/// for orthographic cameras, and if the transform changes angles or lengths.
std::optional<terrain::HorizonView> horizon_view(const scene::Camera& camera, glm::ivec2 size,
                                                 const glm::dmat4& world_from_local, double error);

} // namespace reljef::view
