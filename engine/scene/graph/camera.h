#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/geometry.h"

namespace reljef::scene {

enum class ProjectionKind { perspective, orthographic };

/// Where the viewer stands and how the view is laid on the picture. World metres.
struct Camera {
    glm::dvec3 eye{0.0, -1.0, 0.0};
    glm::dvec3 target{0.0}; ///< a point straight ahead
    glm::dvec3 up{0.0, 0.0, 1.0};
    ProjectionKind projection = ProjectionKind::perspective;
    double vertical_fov = 57.3; ///< degrees, perspective, (0, 180)
    double view_height = 1.0;   ///< metres from the bottom to the top edge, orthographic
    double near = 0.1;          ///< metres to the nearest depth drawn, perspective
    /// Pixels, right and down: the picture shows in each place what else lies so far from it. Moves
    /// where a pixel is sampled.
    glm::dvec2 shift{0.0};
    /// The nearest and farthest depth drawn, metres along the view, orthographic.
    double orthographic_near = -1e7;
    double orthographic_far = 1e7;

    friend bool operator==(const Camera&, const Camera&) = default;
};

/// Unit vectors of the view. Looking along `up`, or at the eye itself, still gives a right frame:
/// north (or east) then is up in the picture.
struct ViewAxes {
    glm::dvec3 right;
    glm::dvec3 up;
    glm::dvec3 forward;
};
ViewAxes view_axes(const Camera& camera);

/// View space (x right, y up, z towards the viewer) from world directions; no translation.
glm::dmat4 view_from_world_rotation(const Camera& camera);

/// Clip from view space, depth reversed to 1 at the near plane: towards 0 at infinity
/// (perspective), 0 at the far plane (orthographic). `size` is the picture's, pixels.
glm::dmat4 clip_from_view(const Camera& camera, glm::ivec2 size);

/// The camera with orthographic depths between which all of `bounds` (world metres) lies; an empty
/// box changes nothing.
Camera with_fitted_depth(Camera camera, const Box& bounds);

/// The whole way; for selection and for oracles. Drawing goes camera-relative instead.
glm::dmat4 clip_from_world(const Camera& camera, glm::ivec2 size);

/// The ray through a place of the picture (pixels, (0,0) the top left corner, pixel centres at .5);
/// its direction has length 1 along the view axis, so t is the depth.
Ray view_ray(const Camera& camera, glm::ivec2 size, glm::dvec2 pixel);

/// Where a world point falls on the picture (pixels, as in view_ray) and its depth along the view
/// axis. Meaningless behind the eye (depth <= 0) in perspective.
struct Projected {
    glm::dvec2 pixel;
    double depth;
};
Projected project(const Camera& camera, glm::ivec2 size, glm::dvec3 world);

/// What angles count from at a place, world directions.
struct Compass {
    glm::dvec3 up{0.0, 0.0, 1.0};
    glm::dvec3 north{0.0, 1.0, 0.0}; ///< need not be level: what is level of it counts
};

/// Heading clockwise from north and pitch above the horizon, degrees; roll is none.
Camera camera_from_angles(glm::dvec3 eye, double heading, double pitch,
                          const Compass& compass = {});

} // namespace reljef::scene
