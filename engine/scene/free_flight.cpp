#include "engine/scene/free_flight.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace reljef::scene {
namespace {

constexpr double degrees_per_pixel = 0.15;
constexpr double steepest_pitch = 89.9; // degrees
constexpr double speed_per_wheel_step = 1.25;
constexpr double longest_step = 0.25; // seconds

// What a key does: metres ahead, to the right and up per metre flown.
struct Motion {
    Key key;
    glm::dvec3 direction;
};
constexpr std::array<Motion, 12> motions{{{Key::w, {1.0, 0.0, 0.0}},
                                          {Key::up, {1.0, 0.0, 0.0}},
                                          {Key::s, {-1.0, 0.0, 0.0}},
                                          {Key::down, {-1.0, 0.0, 0.0}},
                                          {Key::d, {0.0, 1.0, 0.0}},
                                          {Key::right, {0.0, 1.0, 0.0}},
                                          {Key::a, {0.0, -1.0, 0.0}},
                                          {Key::left, {0.0, -1.0, 0.0}},
                                          {Key::e, {0.0, 0.0, 1.0}},
                                          {Key::page_up, {0.0, 0.0, 1.0}},
                                          {Key::q, {0.0, 0.0, -1.0}},
                                          {Key::page_down, {0.0, 0.0, -1.0}}}};

bool is_motion_key(Key key) {
    return key == Key::shift || std::any_of(motions.begin(), motions.end(),
                                            [&](const Motion& motion) { return motion.key == key; });
}

} // namespace

FreeFlight::FreeFlight(Camera start, double speed, double clearance,
                       std::function<std::optional<double>(double x, double y)> ground)
    : speed_(speed), clearance_(clearance), ground_(std::move(ground)) {
    set_camera(start);
}

void FreeFlight::set_camera(const Camera& camera) {
    camera_ = camera;
    const glm::dvec3 forward = view_axes(camera).forward;
    pitch_ = std::clamp(glm::degrees(std::asin(std::clamp(forward.z, -1.0, 1.0))), -steepest_pitch,
                        steepest_pitch);
    const glm::dvec3 level = std::hypot(forward.x, forward.y) > 1e-6 ? forward : view_axes(camera).up;
    heading_ = glm::degrees(std::atan2(level.x, level.y));
    keep_above_ground();
}

Camera FreeFlight::camera() const {
    const Camera turned = camera_from_angles(camera_.eye, heading_, pitch_);
    Camera camera = camera_;
    camera.look = turned.look;
    camera.up = turned.up;
    return camera;
}

void FreeFlight::set_mouse_look(bool on) {
    mouse_look_ = on;
    pointer_.reset();
}

bool FreeFlight::receive(const Event& event) {
    if (const auto* key = std::get_if<KeyEvent>(&event)) {
        return receive_key(*key);
    }
    if (const auto* move = std::get_if<MouseMoveEvent>(&event)) {
        return receive_move(*move);
    }
    if (const auto* button = std::get_if<MouseButtonEvent>(&event)) {
        button_held_ = button->button == MouseButton::left && button->pressed;
        pointer_ = button->position;
        return button->button == MouseButton::left;
    }
    if (const auto* scroll = std::get_if<ScrollEvent>(&event)) {
        speed_ = std::clamp(speed_ * std::pow(speed_per_wheel_step, scroll->offset.y), 1e-2, 1e7);
        return true;
    }
    if (const auto* focus = std::get_if<FocusEvent>(&event); focus != nullptr && !focus->focused) {
        held_.clear();
        button_held_ = false;
    }
    return false;
}

bool FreeFlight::receive_key(const KeyEvent& event) {
    if (!is_motion_key(event.key)) {
        return false;
    }
    if (event.pressed) {
        held_.insert(event.key);
    } else {
        held_.erase(event.key);
    }
    return true;
}

bool FreeFlight::receive_move(const MouseMoveEvent& event) {
    const auto before = std::exchange(pointer_, event.position);
    if (!before || !(mouse_look_ || button_held_)) {
        return false;
    }
    const glm::dvec2 moved = event.position - *before;
    heading_ = std::fmod(heading_ + degrees_per_pixel * moved.x, 360.0);
    pitch_ = std::clamp(pitch_ - degrees_per_pixel * moved.y, -steepest_pitch, steepest_pitch);
    turned_ = true;
    return true;
}

glm::dvec3 FreeFlight::wanted_direction() const {
    const ViewAxes axes = view_axes(camera());
    glm::dvec3 wanted{0.0};
    for (const Motion& motion : motions) {
        if (held_.contains(motion.key)) {
            wanted += motion.direction.x * axes.forward + motion.direction.y * axes.right +
                      motion.direction.z * glm::dvec3(0.0, 0.0, 1.0);
        }
    }
    const double length = glm::length(wanted);
    return length > 0.0 ? wanted / length : wanted;
}

bool FreeFlight::advance(double seconds) {
    const double step = seconds > 0.0 ? std::min(seconds, longest_step) : 0.0;
    const double pace = held_.contains(Key::shift) ? 4.0 * speed_ : speed_;
    const glm::dvec3 way = step * pace * wanted_direction();
    camera_.eye += way;
    keep_above_ground();
    const bool turned = std::exchange(turned_, false);
    return turned || way != glm::dvec3(0.0);
}

void FreeFlight::keep_above_ground() {
    if (const auto ground = ground_(camera_.eye.x, camera_.eye.y)) {
        camera_.eye.z = std::max(camera_.eye.z, *ground + clearance_);
    }
}

} // namespace reljef::scene
