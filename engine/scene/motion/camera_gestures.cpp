#include "engine/scene/motion/camera_gestures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace reljef::scene {
namespace {

constexpr int max_rounds = 50; // of fixed-point iterations; without ground, a plane needs one
constexpr double min_pixels = 1e-3;

bool has_numbers(glm::dvec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool has_numbers(const Grip& grip) {
    return has_numbers(grip.point) && std::isfinite(grip.pixel.x) && std::isfinite(grip.pixel.y);
}

Compass compass_at(glm::dvec3 world, const GestureWorld& in) {
    Compass compass;
    if (in.up) {
        compass.up = in.up(world);
    }
    if (in.north) {
        compass.north = in.north(world);
    }
    return compass;
}

glm::dvec3 lifted(glm::dvec3 eye, const GestureWorld& world) {
    return world.lifted ? world.lifted(eye) : eye;
}

// The ray of a pixel along the picture's right, up and view axes; 1 along the last.
glm::dvec3 in_view(const Camera& camera, glm::dvec2 pixel, const GestureWorld& world) {
    const ViewAxes axes = view_axes(camera);
    const glm::dvec3 ray = view_ray(camera, world.size, pixel).direction;
    return {glm::dot(ray, axes.right), glm::dot(ray, axes.up), 1.0};
}

// How far from its pixel the grip's point is shown; infinite behind the eye.
double pixels_off(const Camera& camera, const Grip& grip, const GestureWorld& world) {
    const Projected shown = project(camera, world.size, grip.point);
    return shown.depth > 0.0 ? glm::distance(shown.pixel, grip.pixel)
                             : std::numeric_limits<double>::infinity();
}

// Rotates a direction so that unit vector `from` becomes `to` (Rodrigues' formula).
glm::dvec3 rotated(glm::dvec3 direction, glm::dvec3 from, glm::dvec3 to) {
    const glm::dvec3 axis = glm::cross(from, to);
    const glm::dvec3 across = glm::cross(axis, direction);
    return direction + across + glm::cross(axis, across) / (1.0 + glm::dot(from, to));
}

// The level surface through a point: a plane, or a ball.
class Level {
public:
    Level(glm::dvec3 point, const GestureWorld& world)
        : point_(point), up_(compass_at(point, world).up), radius_(world.radius),
          center_(is_plane() ? point : point - radius_ * up_) {}

    [[nodiscard]] double height(glm::dvec3 place) const {
        return is_plane() ? glm::dot(place - point_, up_) : glm::distance(place, center_) - radius_;
    }

    [[nodiscard]] glm::dvec3 at_height(glm::dvec3 place, double metres) const {
        return is_plane() ? place + (metres - height(place)) * up_
                          : center_ + (radius_ + metres) * glm::normalize(place - center_);
    }

    // Moves an eye and its view within level surfaces so that the point comes under the ray.
    // Empty if the ray misses this surface.
    struct Moved {
        glm::dvec3 eye;
        glm::dvec3 forward;
    };
    [[nodiscard]] std::optional<Moved> under(const Ray& ray, glm::dvec3 forward) const {
        const auto t = first_meeting(ray);
        if (!t) {
            return std::nullopt;
        }
        if (is_plane()) {
            return Moved{ray.origin + point_ - ray.at(*t), forward};
        }
        const glm::dvec3 from = glm::normalize(ray.at(*t) - center_);
        return Moved{center_ + rotated(ray.origin - center_, from, up_),
                     rotated(forward, from, up_)};
    }

private:
    [[nodiscard]] bool is_plane() const { return !std::isfinite(radius_); }

    [[nodiscard]] std::optional<double> first_meeting(const Ray& ray) const {
        double t = -height(ray.origin) / glm::dot(ray.direction, up_);
        if (!is_plane()) {
            const glm::dvec3 from_center = ray.origin - center_;
            const double a = glm::dot(ray.direction, ray.direction);
            const double b = glm::dot(ray.direction, from_center);
            // A product, because a difference of squares would cancel near the surface.
            const double c = height(ray.origin) * (glm::length(from_center) + radius_);
            const double root = std::sqrt(b * b - a * c);
            t = c > 0.0 ? c / (root - b) : (root - b) / a;
        }
        return t > 0.0 && std::isfinite(t) ? std::optional(t) : std::nullopt;
    }

    glm::dvec3 point_;
    glm::dvec3 up_;
    double radius_;
    glm::dvec3 center_;
};

} // namespace

ViewAngles angles_of(const Camera& camera, const GestureWorld& world) {
    return angles_of(camera, compass_at(camera.eye, world));
}

Camera upright(Camera camera, glm::dvec3 eye, const ViewAngles& angles, const GestureWorld& world) {
    const Camera at =
        camera_from_angles(eye, angles.heading, std::clamp(angles.pitch, -max_pitch, max_pitch),
                           compass_at(eye, world));
    camera.eye = at.eye;
    camera.target = at.target;
    camera.up = at.up;
    return camera;
}

Camera turned(const Camera& camera, const ViewAngles& change, const GestureWorld& world) {
    if (!std::isfinite(change.heading) || !std::isfinite(change.pitch)) {
        return camera;
    }
    const ViewAngles angles = angles_of(camera, world);
    return upright(camera, camera.eye,
                   {angles.heading + std::fmod(change.heading, 360.0), angles.pitch + change.pitch},
                   world);
}

Camera aimed(const Camera& camera, const Grip& grip, const GestureWorld& world) {
    const glm::dvec3 way = grip.point - camera.eye;
    const double distance = glm::length(way);
    if (!has_numbers(grip) || !(distance > 0.0)) {
        return camera;
    }
    const Compass compass = compass_at(camera.eye, world);
    glm::dvec3 ray = in_view(camera, grip.pixel, world);
    // The ray rises by sin(pitch) + ray.y·cos(pitch) = tall·sin(pitch + tilt) for each metre ahead.
    const double tall = std::hypot(1.0, ray.y);
    const double tilt = glm::degrees(std::atan(ray.y));
    const double rise = glm::dot(way, compass.up) / distance;
    // A steep ray is never far from the middle column.
    const double max_x = tall * std::sqrt(std::max(0.0, 1.0 / (rise * rise) - 1.0));
    ray.x = std::clamp(ray.x, -max_x, max_x);
    const double upward =
        glm::degrees(std::asin(std::clamp(rise * glm::length(ray) / tall, -1.0, 1.0)));
    const double before = angles_of(camera, world).pitch;
    const auto farness = [&](double found) { // an upright pitch first, then the nearest
        return std::pair(std::max(0.0, std::abs(found) - max_pitch), std::abs(found - before));
    };
    const double pitch = std::min({upward - tilt, 180.0 - upward - tilt, -180.0 - upward - tilt},
                                  [&](double a, double b) { return farness(a) < farness(b); });
    const double p = glm::radians(pitch);
    const double beside = glm::degrees(std::atan2(ray.x, std::cos(p) - ray.y * std::sin(p)));
    return upright(camera, camera.eye, {heading_of(way, compass) - beside, pitch}, world);
}

Camera zoomed(const Camera& camera, const Grip& grip, double factor, const GestureWorld& world) {
    const glm::dvec3 from_point = camera.eye - grip.point;
    const double distance = glm::length(from_point);
    if (!has_numbers(grip) || !(factor > 0.0) || !(distance > 0.0)) {
        return camera;
    }
    // An eye that is already beyond a limit does not jump to it.
    const double low = std::min(distance, world.min_distance);
    const double high = std::max(distance, world.max_distance);
    const double length = std::clamp(factor * distance, low, high);
    const glm::dvec3 eye = lifted(grip.point + length / distance * from_point, world);
    return aimed(upright(camera, eye, angles_of(camera, world), world), grip, world);
}

Camera orbited(const Camera& camera, const Grip& grip, const ViewAngles& change,
               const GestureWorld& world) {
    const double distance = glm::distance(camera.eye, grip.point);
    if (!has_numbers(grip) || !std::isfinite(change.heading) || !std::isfinite(change.pitch) ||
        !(distance > 0.0)) {
        return camera;
    }
    Camera around = turned(camera, change, world);
    const ViewAngles angles = angles_of(around, world);
    for (int round = 0; round < max_rounds; ++round) {
        const glm::dvec3 ray = glm::normalize(view_ray(around, world.size, grip.pixel).direction);
        around = upright(around, grip.point - distance * ray, angles, world);
        if (pixels_off(around, grip, world) < min_pixels) {
            break;
        }
    }
    return aimed(upright(around, lifted(around.eye, world), angles, world), grip, world);
}

Camera panned(const Camera& camera, const Grip& grip, const GestureWorld& world) {
    if (!has_numbers(grip)) {
        return camera;
    }
    const double pitch = angles_of(camera, world).pitch;
    const Level level(grip.point, world);
    const double height = level.height(camera.eye);
    Camera found = camera;
    for (int round = 0; round < max_rounds; ++round) {
        const Ray ray = view_ray(found, world.size, grip.pixel);
        const auto moved = level.under(ray, view_axes(found).forward);
        if (!moved || !has_numbers(moved->eye)) {
            return camera;
        }
        const glm::dvec3 eye = lifted(level.at_height(moved->eye, height), world);
        found =
            upright(found, eye, {heading_of(moved->forward, compass_at(eye, world)), pitch}, world);
        if (pixels_off(found, grip, world) < min_pixels) {
            return found;
        }
    }
    return aimed(found, grip, world); // steep ground below the eye: the angles give way
}

} // namespace reljef::scene
