#include "engine/scene/motion/node_motions.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "engine/core/check.h"

namespace reljef::scene {
namespace {

// The place in a period of `count` steps, in [0, count); 0 for what is not finite.
double place_in_period(double steps, double count) {
    const double place = steps - count * std::floor(steps / count);
    return place >= 0.0 && place < count ? place : 0.0;
}

// Steps since the beginning; infinite if a step takes no time.
double steps_since_begin(double time, double seconds) {
    const double steps = seconds > 0.0 ? time / seconds : std::numeric_limits<double>::infinity();
    return std::isnan(time) || std::isnan(steps) ? 0.0 : steps;
}

// A motion of `count` steps, in [0, count].
double place_among(double steps, double count, AfterEnd after) {
    if (after == AfterEnd::stay || !std::isfinite(steps)) {
        return std::clamp(steps, 0.0, count);
    }
    if (after == AfterEnd::repeat) {
        return place_in_period(steps, count);
    }
    const double place = place_in_period(steps, 2.0 * count);
    return place <= count ? place : 2.0 * count - place;
}

// Unit vectors across an axis; around z the first is x and the second y.
struct Across {
    glm::dvec3 first;
    glm::dvec3 second;
};
Across across(glm::dvec3 axis) {
    check(axis != glm::dvec3(0.0), "an axis with a direction was expected");
    const glm::dvec3 unit = glm::normalize(axis);
    const bool is_nearer_y = std::abs(unit.y) > std::abs(unit.z);
    const glm::dvec3 beside = is_nearer_y ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(0.0, 1.0, 0.0);
    const glm::dvec3 first = glm::normalize(glm::cross(beside, unit));
    return {first, glm::cross(unit, first)};
}

void set_turn(Node& node, const glm::dmat3& rotation) {
    glm::dmat4 transform(rotation);
    transform[3] = node.parent_from_local()[3];
    node.set_parent_from_local(transform);
}

} // namespace

glm::dvec3 FlyCircle::at(double time) const {
    const double turns = seconds != 0.0 ? place_in_period(time / seconds, 1.0) : 0.0;
    const double angle = 2.0 * glm::radians(180.0) * turns + glm::radians(turn);
    const Across plane = across(axis);
    return center + radius * (std::cos(angle) * plane.first + std::sin(angle) * plane.second);
}

glm::dvec3 FlyStraight::at(double time) const {
    const double share = place_among(steps_since_begin(time, seconds), 1.0, after);
    return (1.0 - share) * from + share * to;
}

glm::dvec3 FollowSpline::at(double time) const {
    check(!points.empty(), "a spline needs at least one point");
    const std::size_t count = points.size();
    const bool is_closed = after == AfterEnd::repeat;
    const std::size_t pieces = is_closed ? count : count - 1;
    if (pieces == 0) {
        return points.front();
    }
    const double place =
        place_among(steps_since_begin(time, seconds), static_cast<double>(pieces), after);
    const std::size_t piece = std::min(static_cast<std::size_t>(place), pieces - 1);
    const double t = place - static_cast<double>(piece);
    // Point `piece` + `step` - 1; the ends of an open spline are points twice.
    const auto point = [&](std::size_t step) {
        const std::size_t next = piece + step;
        return is_closed ? points[(next + count - 1) % count]
                         : points[std::clamp<std::size_t>(next, 1, count) - 1];
    };
    const glm::dvec3 begin = point(1);
    const glm::dvec3 end = point(2);
    const glm::dvec3 leaving = tightness * (end - point(0));
    const glm::dvec3 arriving = tightness * (point(3) - begin);
    const glm::dvec3 rise = end - begin;
    return begin + t * (leaving + t * (3.0 * rise - 2.0 * leaving - arriving +
                                       t * (leaving + arriving - 2.0 * rise)));
}

glm::dmat3 Rotation::at(double time) const {
    check(axis != glm::dvec3(0.0), "an axis with a direction was expected");
    const double degrees = place_in_period(time * degrees_per_second, 360.0);
    const glm::dmat4 turned =
        glm::rotate(glm::dmat4(1.0), glm::radians(degrees), glm::normalize(axis));
    return glm::dmat3(turned) * begin;
}

std::shared_ptr<const material::ReliefMaterial> TextureCycle::at(double time) const {
    check(!sets.empty(), "a cycle of textures needs at least one");
    const std::size_t last = sets.size() - 1;
    // Back and forth, the first and the last are shown once.
    const double count = static_cast<double>(after == AfterEnd::turn_back ? last : sets.size());
    if (last == 0) {
        return sets.front();
    }
    const double steps = std::floor(steps_since_begin(time, seconds));
    return sets[std::min(static_cast<std::size_t>(place_among(steps, count, after)), last)];
}

Animator animator(const FlyCircle& motion) {
    return [motion](Node& node, double time) { node.set_position(motion.at(time)); };
}

Animator animator(const FlyStraight& motion) {
    return [motion](Node& node, double time) { node.set_position(motion.at(time)); };
}

Animator animator(FollowSpline motion) {
    return [motion = std::move(motion)](Node& node, double time) {
        node.set_position(motion.at(time));
    };
}

Animator animator(const Rotation& motion) {
    return [motion](Node& node, double time) { set_turn(node, motion.at(time)); };
}

Animator animator(TextureCycle motion) {
    return [motion = std::move(motion)](Node& node, double time) {
        if (auto* const mesh = node.get<MeshNode>()) {
            mesh->material.detail.set = motion.at(time);
        }
    };
}

} // namespace reljef::scene
