#include "engine/scene/motion/poses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace reljef::scene {
namespace {

// In the order of Pose.
constexpr std::array<std::string_view, 6> pose_names{"overview", "oblique", "low",
                                                     "grazing",  "valley",  "map"};

using Ground = std::function<double(double x, double y)>;

// Above the ground, by a share of the relief. On level ground the eye would else lie in it.
double eye_height(const Box& bounds, double share) {
    return std::max(share * bounds.size().z, 1e-4 * bounds.size().x);
}

Camera valley_camera(const Box& bounds, const Ground& ground) {
    constexpr int steps = 32; // of a lattice over the middle
    const double side = 0.5 * bounds.size().x;
    glm::dvec3 lowest(0.0, 0.0, std::numeric_limits<double>::infinity());
    glm::dvec3 highest(0.0, 0.0, -std::numeric_limits<double>::infinity());
    for (int i = 0; i <= steps; ++i) {
        for (int j = 0; j <= steps; ++j) {
            const double x = bounds.center().x + side * (1.0 * i / steps - 0.5);
            const double y = bounds.center().y + side * (1.0 * j / steps - 0.5);
            const double z = ground(x, y);
            lowest = z < lowest.z ? glm::dvec3(x, y, z) : lowest;
            highest = z > highest.z ? glm::dvec3(x, y, z) : highest;
        }
    }
    Camera camera;
    camera.eye = lowest + glm::dvec3(0.0, 0.0, eye_height(bounds, 0.01));
    camera.target = lowest.z < highest.z ? highest : camera.eye + glm::dvec3(0.0, side, 0.0);
    return camera;
}

Camera map_camera(const Box& bounds) {
    Camera camera;
    camera.projection = ProjectionKind::orthographic;
    camera.target = bounds.center();
    camera.eye = {camera.target.x, camera.target.y, bounds.high.z + 1.0};
    camera.up = {0.0, 1.0, 0.0};
    camera.view_height = 1.02 * std::max(bounds.size().y, 0.75 * bounds.size().x);
    return camera;
}

std::array<glm::dvec3, 8> corners_of(const Box& box) {
    std::array<glm::dvec3, 8> corners{};
    for (unsigned i = 0; i < corners.size(); ++i) {
        corners.at(i) = {(i & 1U) != 0 ? box.high.x : box.low.x,
                         (i & 2U) != 0 ? box.high.y : box.low.y,
                         (i & 4U) != 0 ? box.high.z : box.low.z};
    }
    return corners;
}

// Where the eye lies along one axis of the picture and along the view so that two opposite sides of
// its pyramid touch the points.
struct Fit {
    double across;
    double along;
};

// `tangent`: of the angle between the view and each of the two sides.
Fit fit_between(const std::array<glm::dvec3, 8>& points, glm::dvec3 axis, glm::dvec3 forward,
                double tangent) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const glm::dvec3 point : points) {
        const double narrowing = tangent * glm::dot(point, forward);
        low = std::min(low, glm::dot(point, axis) + narrowing);
        high = std::max(high, glm::dot(point, axis) - narrowing);
    }
    return {0.5 * (low + high), 0.5 * (low - high) / tangent};
}

// As fit_between, with a smaller tangent if the eye would else lie farther along the view.
Fit fit_up_to(double along, const std::array<glm::dvec3, 8>& points, glm::dvec3 axis,
              glm::dvec3 forward, double tangent) {
    Fit fit = fit_between(points, axis, forward, tangent);
    if (fit.along <= along) {
        return fit;
    }
    constexpr int halvings = 60;
    double narrow = 0.0;
    double wide = tangent;
    for (int i = 0; i < halvings; ++i) {
        const double middle = 0.5 * (narrow + wide);
        fit = fit_between(points, axis, forward, middle);
        (fit.along <= along ? narrow : wide) = middle;
    }
    return {fit.across, along};
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

Camera pose_camera(Pose pose, const Box& bounds, const Ground& ground) {
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
        camera.eye.z = ground(camera.eye.x, camera.eye.y) + eye_height(bounds, 0.15);
        camera.target = middle + glm::dvec3(0.05 * w, 0.4 * w, h0);
        return camera;
    case Pose::grazing:
        camera.eye = middle + glm::dvec3(0.0, -0.6 * w, h1 + 0.03 * w);
        camera.target = middle + glm::dvec3(0.0, 0.0, h1);
        return camera;
    case Pose::valley:
        return valley_camera(bounds, ground);
    case Pose::map:
        return map_camera(bounds);
    }
    return camera;
}

Camera whole_camera(const Box& bounds, double vertical_fov, double aspect) {
    constexpr double filled = 0.9; // of the picture
    const glm::dvec3 center = bounds.center();
    Camera camera = camera_from_angles(center, 0.0, -35.0);
    camera.up = {0.0, 0.0, 1.0};
    camera.vertical_fov = vertical_fov;
    const ViewAxes axes = view_axes(camera);
    const auto corners = corners_of({bounds.low - center, bounds.high - center});
    const double tangent = filled * std::tan(0.5 * glm::radians(vertical_fov));
    const double along = fit_between(corners, axes.right, axes.forward, aspect * tangent).along;
    const Fit fit = fit_up_to(along, corners, axes.up, axes.forward, tangent);
    camera.eye = center + fit.across * axes.up + fit.along * axes.forward;
    camera.target = camera.eye + glm::dot(center - camera.eye, axes.forward) * axes.forward;
    return camera;
}

} // namespace reljef::scene
