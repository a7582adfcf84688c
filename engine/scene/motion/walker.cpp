#include "engine/scene/motion/walker.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "engine/core/check.h"

namespace reljef::scene {
namespace {

constexpr double parts_of_size = 4.0; // steps of a way, in the smaller semi-axis
constexpr int max_steps = 512;

// What stops a body.
class BodyOnGround {
public:
    BodyOnGround(const TerrainNode& terrain, const WalkingBody& body)
        : terrain_(terrain), body_(body),
          size_(std::min(body.shape.radius, body.shape.half_height)),
          min_rise_(std::cos(glm::radians(body.max_slope))) {}

    [[nodiscard]] glm::dvec3 up(glm::dvec3 center) const {
        return terrain_.surface->placement().up(center);
    }

    [[nodiscard]] std::optional<GroundContact> contact(glm::dvec3 center) const {
        return ground_contact(terrain_, body_.shape, center);
    }

    [[nodiscard]] int steps_of(double length) const {
        return 1 + clamped_int(parts_of_size * length / size_, 0, max_steps - 1);
    }

    // The nearest centre at which the body does not reach into the ground: the surface's tangent at
    // the deepest place is met a few times, then the rest is up. From deep in the ground it is up.
    [[nodiscard]] glm::dvec3 pushed_out(glm::dvec3 center) const {
        constexpr int rounds = 4;
        auto touched = contact(center);
        for (int i = 0; touched && touched->lift > 0.0; ++i) {
            const glm::dvec3 above = up(center);
            const double depth = touched->lift * glm::dot(touched->normal, above);
            if (i == rounds || depth > size_) {
                return center + touched->lift * above;
            }
            center += depth * touched->normal;
            touched = contact(center);
        }
        return center;
    }

    [[nodiscard]] glm::dvec3 slid(glm::dvec3 center, glm::dvec3 way) const {
        const int steps = way != glm::dvec3(0.0) ? steps_of(glm::length(way)) : 0;
        for (int i = 0; i < steps; ++i) {
            center = pushed_out(center + way / static_cast<double>(steps));
        }
        return center;
    }

    [[nodiscard]] bool stands(const GroundContact& touched, glm::dvec3 center) const {
        return touched.lift >= 0.0 && glm::dot(touched.normal, up(center)) >= min_rise_;
    }

    // A walker that stood follows the ground down to what it may stand on.
    [[nodiscard]] glm::dvec3 set_down(glm::dvec3 center, double walked) const {
        const auto touched = contact(center);
        const double deepest = walked * std::tan(glm::radians(body_.max_slope));
        const bool is_near = touched && touched->lift <= 0.0 && -touched->lift <= deepest;
        return is_near && glm::dot(touched->normal, up(center)) >= min_rise_
                   ? center + touched->lift * up(center)
                   : center;
    }

    [[nodiscard]] Walker fallen(const Walker& before, double seconds) const {
        const glm::dvec3 velocity = before.velocity - seconds * body_.gravity * up(before.center);
        const glm::dvec3 way = 0.5 * seconds * (before.velocity + velocity);
        const int steps = steps_of(glm::length(way));
        Walker now{before.center, velocity, false};
        for (int i = 0; i < steps; ++i) {
            now.center += way / static_cast<double>(steps);
            const auto touched = contact(now.center);
            if (touched && stands(*touched, now.center)) {
                return {now.center + touched->lift * up(now.center), glm::dvec3(0.0), true};
            }
            if (touched && touched->lift > 0.0) {
                now.center = pushed_out(now.center);
                now.velocity -=
                    std::min(glm::dot(now.velocity, touched->normal), 0.0) * touched->normal;
            }
        }
        return now;
    }

private:
    const TerrainNode& terrain_;
    const WalkingBody& body_;
    double size_;     // the smaller semi-axis, metres
    double min_rise_; // of the normal of ground on which the body stands
};

bool is_finite_place(glm::dvec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

} // namespace

Walker walked(const TerrainNode& terrain, const WalkingBody& body, const Walker& before,
              glm::dvec3 way, double seconds) {
    check(body.max_slope >= 0.0 && body.max_slope < 90.0, "a slope below 90 degrees was expected");
    const BodyOnGround ground(terrain, body);
    if (!is_finite_place(before.center)) {
        return before;
    }
    way = is_finite_place(way) ? way : glm::dvec3(0.0);
    Walker now = before;
    now.velocity = is_finite_place(before.velocity) ? before.velocity : glm::dvec3(0.0);
    now.center = ground.slid(ground.pushed_out(before.center), way);
    if (!(body.gravity > 0.0) || !(seconds > 0.0) || !std::isfinite(seconds)) {
        return now;
    }
    const glm::dvec3 up = ground.up(before.center);
    if (now.on_ground && glm::dot(now.velocity, up) <= 0.0 && glm::dot(way, up) <= 0.0) {
        now.center = ground.set_down(now.center, glm::length(way - glm::dot(way, up) * up));
    }
    return ground.fallen(now, seconds);
}

} // namespace reljef::scene
