#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/geometry.h"

namespace reljef::scene {

enum class ProjectionKind { perspective, orthographic };

/// World metres.
struct Camera {
    glm::dvec3 eye{0.0, -1.0, 0.0};
    glm::dvec3 target{0.0}; ///< a point straight ahead
    glm::dvec3 up{0.0, 0.0, 1.0};
    ProjectionKind projection = ProjectionKind::perspective;
    double vertical_fov = 57.3;      ///< degrees, perspective, (0, 180)
    double view_height = 1.0;        ///< metres from the bottom to the top edge, orthographic
    double near = 0.1;               ///< depth of the near plane, metres, perspective
    glm::dvec2 shift{0.0};           ///< offset of the sample in each pixel, pixels right and down
    glm::ivec2 whole{0};             ///< size of the picture that this is a part of; 0: it is none
    glm::ivec2 first{0};             ///< upper left pixel of the part
    double orthographic_near = -1e7; ///< depth of the near plane, metres, orthographic
    double orthographic_far = 1e7;

    friend bool operator==(const Camera&, const Camera&) = default;
};

/// Unit vectors of the view. If the view is parallel to `up` or has no direction, north (or east)
/// is up in the picture.
struct ViewAxes {
    glm::dvec3 right;
    glm::dvec3 up;
    glm::dvec3 forward;
};
ViewAxes view_axes(const Camera& camera);

/// View space (x right, y up, z towards the viewer) from world directions; no translation.
glm::dmat4 view_from_world_rotation(const Camera& camera);

/// Reversed depth: 1 at the near plane, 0 at infinity (perspective) or at the far plane
/// (orthographic). `size`: of the picture, pixels.
glm::dmat4 clip_from_view(const Camera& camera, glm::ivec2 size);

/// The size of all of the picture that a picture of `size` pixels is a part of.
inline glm::ivec2 whole_picture(const Camera& camera, glm::ivec2 size) {
    return camera.whole == glm::ivec2(0) ? size : camera.whole;
}

struct PicturePart {
    glm::ivec2 first{0}; ///< its upper left pixel in the picture
    glm::ivec2 size{0};  ///< pixels; it may reach beyond the picture
};
/// The camera of a part of its picture: rays through the part's pixels are those of the picture.
Camera part_camera(Camera camera, glm::ivec2 picture, const PicturePart& part);

/// The camera of the picture that a part of `size` pixels belongs to; of no part, the same camera.
Camera camera_of_whole(Camera camera, glm::ivec2 size);

/// Fits the orthographic depth range to `bounds` (world metres); an empty box changes nothing.
Camera with_fitted_depth(Camera camera, const Box& bounds);

/// For selection and tests; drawing is relative to the camera.
glm::dmat4 clip_from_world(const Camera& camera, glm::ivec2 size);

/// Width of a pixel, metres: x at the eye, plus y per metre of distance.
glm::vec2 metres_a_pixel(const Camera& camera, glm::ivec2 size);

/// The ray through a place of the picture (pixels from the top left corner, centres at .5). Its
/// direction has length 1 along the view axis, so t is the depth.
Ray view_ray(const Camera& camera, glm::ivec2 size, glm::dvec2 pixel);

/// A world point on the picture (pixels, as in view_ray) and its depth along the view axis.
/// Undefined behind the eye (depth <= 0) in perspective.
struct Projected {
    glm::dvec2 pixel;
    double depth;
};
Projected project(const Camera& camera, glm::ivec2 size, glm::dvec3 world);

/// The reference directions of angles, in the world.
struct Compass {
    glm::dvec3 up{0.0, 0.0, 1.0};
    glm::dvec3 north{0.0, 1.0, 0.0}; ///< its horizontal part counts
};

/// Heading clockwise from north and pitch above the horizon, degrees; no roll.
Camera camera_from_angles(glm::dvec3 eye, double heading, double pitch,
                          const Compass& compass = {});

/// Degrees clockwise from north, of the horizontal part of a direction.
double heading_of(glm::dvec3 direction, const Compass& compass);

/// Degrees clockwise from north, and above the horizon.
struct ViewAngles {
    double heading = 0.0;
    double pitch = 0.0;
};
/// Of a view straight up or down, up in the picture is the heading.
ViewAngles angles_of(const Camera& camera, const Compass& compass);

} // namespace reljef::scene
