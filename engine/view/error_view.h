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
/// The error of places that are interpolated in floats between a triangle's corners, pixels.
inline constexpr double interpolation_error = 0.75 / 256.0;
/// The rasterizer's part of the error, pixels: half the diagonal of a step, and interpolation.
inline constexpr double rasterizer_error = 0.75 / 256.0 + interpolation_error;

/// Smallest and largest allowed error bound, pixels.
inline constexpr double min_error = scene::min_polygons_error;
inline constexpr double max_error = scene::max_polygons_error;

/// See terrain::ErrorView::morph_from. A smaller share takes more triangles, a larger one moves
/// vertices faster.
inline constexpr double morph_from = 0.5;

/// How a picture of `size` pixels shows displacements of a terrain placed as `kind` in a node: at
/// most `max_error` pixels, the rasterizer's error and the rounding of floats included, unless the
/// rounding takes nearly all of it (exceeded_by_rounding). Preconditions: max_error >
/// rasterizer_error, world_from_local is affine.
terrain::ErrorView error_view(const scene::Camera& camera, glm::ivec2 size,
                              const glm::dmat4& world_from_local, terrain::PlacementKind kind,
                              double max_error);

/// What floats and the rasterizer leave of an error bound.
struct BoundLeft {
    double error = 0.0;                ///< for tiles and triangles, pixels
    double vertex_rounding = 0.0;      ///< of each place by floats, pixels, at most
    double of_operations = 0.0;        ///< its part for places as far away as what is seen
    double corner_rounding = 0.0;      ///< its part for corners farther away than what is seen
    double interpolation = 0.0;        ///< allowed to places within triangles, pixels
    bool exceeded_by_rounding = false; ///< `error` is larger than what rounding leaves
};
/// Precondition: max_error > rasterizer_error.
BoundLeft left_of_bound(const scene::Camera& camera, glm::ivec2 size, double max_error);

/// How far what triangles within the view's error show is off in all, pixels.
inline double error_with_rounding(const terrain::ErrorView& view) {
    return view.max_error + view.vertex_rounding + rasterizer_error;
}

/// A picture with more around it.
struct WiderPicture {
    scene::Camera camera;
    glm::ivec2 size{0}; ///< pixels
};
/// `margin`: pixels on each side, rounded up.
WiderPicture wider_picture(scene::Camera camera, glm::ivec2 size, double margin);

/// How far errors of a terrain move the pixels that show it.
class PictureError {
public:
    /// Precondition: world_from_local is affine.
    PictureError(const scene::Camera& camera, glm::ivec2 size, const glm::dmat4& world_from_local);

    /// Places in a box that are off along their verticals.
    struct Places {
        Box box;            ///< contains what is drawn, local metres
        double error = 0.0; ///< at most, scene metres
        glm::dvec3 up{0.0}; ///< unit, local: the vertical in the middle
        double turn = 0.0;  ///< of the vertical to those of the other places, at most; radians
    };
    /// Upper bound for the visible places, pixels, without the rasterizer's error. Infinite if the
    /// true places may be at the eye.
    [[nodiscard]] double of(const Places& places) const;

    /// The same for places in a box (local metres) that are off in any direction, by local metres.
    [[nodiscard]] double of_any_direction(const Box& box, double error) const;

    /// How many times as far from the eye as its visible places a box's other places may be, at
    /// most; 1 without perspective.
    [[nodiscard]] double depth_ratio(const Box& box) const;

private:
    // Of a box in the picture.
    struct Seen {
        glm::dvec3 to_middle{0.0}; // from the eye, world metres
        double radius = 0.0;
        double angle = 0.0; // of visible places from the middle of the picture at most, radians
        double depth = 0.0; // of visible places at least, metres
    };
    [[nodiscard]] Seen seen(const Box& box) const;

    glm::dmat4 world_from_local_;
    scene::ViewAxes axes_;
    glm::dvec3 eye_;
    double near_;
    double corner_angle_;     // from the middle of the picture, radians; 0: orthographic
    double pixels_per_metre_; // in perspective at a depth of one metre
    double stretch_;          // world metres per local metre
};

/// The view for a horizon in a terrain's local frame, if pixels may be off by `error` pixels. Empty
/// for orthographic cameras, and if the transform changes angles or lengths.
std::optional<terrain::HorizonView> horizon_view(const scene::Camera& camera, glm::ivec2 size,
                                                 const glm::dmat4& world_from_local, double error);

} // namespace reljef::view
