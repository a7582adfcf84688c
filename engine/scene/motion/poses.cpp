#include "engine/scene/motion/poses.h"

#include <algorithm>
#include <array>

namespace reljef::scene {
namespace {

// In the order of Pose.
constexpr std::array<std::string_view, 5> pose_names{"overview", "oblique", "low", "grazing",
                                                     "map"};

Camera map_camera(const Box& bounds) {
    Camera camera;
    camera.projection = ProjectionKind::orthographic;
    camera.target = bounds.center();
    camera.eye = {camera.target.x, camera.target.y, bounds.high.z + 1.0};
    camera.up = {0.0, 1.0, 0.0};
    camera.view_height = 1.02 * std::max(bounds.size().y, 0.75 * bounds.size().x);
    return camera;
}

} // namespace

std::string_view to_string(Pose pose) {
    return pose_names.at(static_cast<std::size_t>(pose));
}

std::optional<Pose> pose_from_string(std::string_view text) {
    const auto* const found = std::find(pose_names.begin(), pose_names.end(), text);
    return found == pose_names.end() ? std::nullopt
                                     : std::optional(static_cast<Pose>(found - pose_names.begin()));
}

Camera pose_camera(Pose pose, const Box& bounds,
                   const std::function<double(double x, double y)>& ground) {
    const double w = bounds.size().x;
    const double h0 = bounds.low.z;
    const double h1 = bounds.high.z;
    const glm::dvec3 middle{bounds.center().x, bounds.center().y, 0.0};
    Camera camera;
    switch (pose) {
    case Pose::overview:
    case Pose::oblique:
        camera.eye = middle + glm::dvec3(0.0, -0.65 * w, h1 + 0.35 * w);
        camera.target = middle + glm::dvec3(0.0, -0.05 * w, pose == Pose::overview ? h0 : h1);
        return camera;
    case Pose::low:
        camera.eye = middle + glm::dvec3(0.0, -0.3 * w, 0.0);
        camera.eye.z = ground(camera.eye.x, camera.eye.y) + 0.15 * (h1 - h0);
        camera.target = middle + glm::dvec3(0.05 * w, 0.4 * w, h0);
        return camera;
    case Pose::grazing:
        camera.eye = middle + glm::dvec3(0.0, -0.6 * w, h1 + 0.03 * w);
        camera.target = middle + glm::dvec3(0.0, 0.0, h1);
        return camera;
    case Pose::map:
        return map_camera(bounds);
    }
    return camera;
}

} // namespace reljef::scene
