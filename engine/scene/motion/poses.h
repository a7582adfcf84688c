#pragma once

#include <functional>
#include <optional>
#include <string_view>

#include "engine/core/geometry.h"
#include "engine/scene/graph/camera.h"

namespace reljef::scene {

/// The standard viewpoints of the benchmarks. w: width (x) of the bounds, centred at the origin;
/// h0, h1: their lowest and highest z; vertical field of view 57.3°. The middle is within 0.25w.
/// The eye is at least 0.0001w above the ground.
enum class Pose {
    overview, ///< eye (0, −0.65w, h1 + 0.35w), target (0, −0.05w, h0)
    oblique,  ///< eye (0, −0.65w, h1 + 0.35w), target (0, −0.05w, h1): for reliefs below z = 0
    low,      ///< eye (0, −0.3w, ground + 0.15(h1 − h0)), target (0.05w, 0.4w, h0)
    grazing,  ///< eye (0, −0.6w, h1 + 0.03w), target (0, 0, h1)
    valley, ///< eye on the lowest ground of the middle + 0.01(h1 − h0), target: its highest ground
    map,    ///< straight down on everything, north up, orthographic
};

std::string_view to_string(Pose pose);
std::optional<Pose> pose_from_string(std::string_view text);

/// `ground`: height of the surface at x, y, scene metres.
Camera pose_camera(Pose pose, const Box& bounds,
                   const std::function<double(double x, double y)>& ground);

/// Looks north and 35 degrees down at all of a box. The picture, `aspect` times as wide as high,
/// has a margin of a twentieth at the two sides that the box fills, and equal margins at the
/// others. `vertical_fov`: degrees, (0, 180).
Camera whole_camera(const Box& bounds, double vertical_fov, double aspect);

} // namespace reljef::scene
