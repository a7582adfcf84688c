#include "engine/scene/motion/free_flight.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "engine/scene/motion/camera_gestures.h"

namespace reljef::scene {
namespace {

constexpr double degrees_per_pixel = 0.15;
constexpr double speed_per_wheel_step = 1.25;
constexpr double min_speed = 1e-2; // metres a second
constexpr double max_speed = 1e7;
constexpr double shift_factor = 4.0;
constexpr double max_step = 0.25; // seconds
constexpr double rounding = 1e-7; // metres, of places on Earth (max_world_coordinate)

struct Steering {
    Key key;
    Key alternative;
    glm::dvec3 direction; // right, ahead, up
};
constexpr std::array<Steering, 6> steerings{{{Key::w, Key::up, {0.0, 1.0, 0.0}},
                                             {Key::s, Key::down, {0.0, -1.0, 0.0}},
                                             {Key::d, Key::right, {1.0, 0.0, 0.0}},
                                             {Key::a, Key::left, {-1.0, 0.0, 0.0}},
                                             {Key::e, Key::page_up, {0.0, 0.0, 1.0}},
                                             {Key::q, Key::page_down, {0.0, 0.0, -1.0}}}};

bool is_steering_key(Key key) {
    const auto has_key = [&](const Steering& steering) {
        return steering.key == key || steering.alternative == key;
    };
    return key == Key::shift || std::any_of(steerings.begin(), steerings.end(), has_key);
}

bool is_finite(glm::dvec2 v) {
    return std::isfinite(v.x) && std::isfinite(v.y);
}

} // namespace

bool SteeringKeys::receive(const KeyEvent& event) {
    if (!is_steering_key(event.key)) {
        return false;
    }
    if (!event.pressed) {
        held_.erase(event.key);
        return true;
    }
    if (event.modifiers.control || event.modifiers.alt || event.modifiers.super) {
        return false;
    }
    held_.insert(event.key);
    tapped_.insert(event.key);
    return true;
}

void SteeringKeys::release_all() {
    held_.clear();
    tapped_.clear();
}

glm::dvec3 SteeringKeys::direction() const {
    glm::dvec3 desired{0.0};
    for (const Steering& steering : steerings) {
        for (const Key key : {steering.key, steering.alternative}) {
            desired += is_down(key) ? steering.direction : glm::dvec3(0.0);
        }
    }
    const double length = glm::length(desired);
    return length > 0.0 ? desired / length : desired;
}

FreeFlight::FreeFlight(const Camera& start, FreeFlightOptions options)
    : options_(std::move(options)), speed_(std::clamp(options_.speed, min_speed, max_speed)) {
    set_camera(start);
}

glm::dvec3 FreeFlight::up() const {
    return options_.up ? options_.up(camera_.eye) : glm::dvec3(0.0, 0.0, 1.0);
}

Compass FreeFlight::compass() const {
    Compass compass;
    compass.up = up();
    if (options_.north) {
        compass.north = options_.north(camera_.eye);
    }
    return compass;
}

void FreeFlight::set_camera(const Camera& camera) {
    camera_ = camera;
    const ViewAngles angles = angles_of(camera, compass());
    pitch_ = std::clamp(angles.pitch, -max_pitch, max_pitch);
    heading_ = angles.heading;
    height_.reset();
    turned_ = false;
    keep_above_ground();
}

Camera FreeFlight::camera() const {
    const Camera turned = camera_from_angles(camera_.eye, heading_, pitch_, compass());
    Camera camera = camera_;
    camera.target = turned.target;
    camera.up = turned.up;
    return camera;
}

void FreeFlight::set_mouse_look(bool on) {
    mouse_look_ = on;
    pointer_.reset();
}

bool FreeFlight::is_steered() const {
    return turned_ || keys_.direction() != glm::dvec3(0.0);
}

void FreeFlight::let_go() {
    keys_.release_all();
    pointer_.reset();
}

bool FreeFlight::receive(const Event& event) {
    if (const auto* key = std::get_if<KeyEvent>(&event)) {
        return keys_.receive(*key);
    }
    if (const auto* move = std::get_if<MouseMoveEvent>(&event)) {
        return receive_move(*move);
    }
    if (const auto* focus = std::get_if<FocusEvent>(&event); focus != nullptr && !focus->focused) {
        let_go();
    }
    return false;
}

void FreeFlight::change_speed(double steps) {
    set_speed(speed_ * std::pow(speed_per_wheel_step, steps));
}

void FreeFlight::set_speed(double speed) {
    if (!std::isnan(speed)) {
        speed_ = std::clamp(speed, min_speed, max_speed);
    }
}

bool FreeFlight::receive_move(const MouseMoveEvent& event) {
    const auto before = std::exchange(pointer_, event.position);
    if (!before || !mouse_look_) {
        return false;
    }
    const glm::dvec2 moved = event.position - *before;
    if (!is_finite(moved)) {
        return true;
    }
    heading_ = std::fmod(heading_ + degrees_per_pixel * moved.x, 360.0);
    pitch_ = std::clamp(pitch_ - degrees_per_pixel * moved.y, -max_pitch, max_pitch);
    turned_ = turned_ || moved != glm::dvec2(0.0);
    return true;
}

bool FreeFlight::advance(double seconds) {
    const double step = seconds > 0.0 ? std::min(seconds, max_step) : 0.0;
    const double way = step * speed_ * (keys_.is_fast() ? shift_factor : 1.0);
    const glm::dvec3 desired = way * keys_.direction();
    const glm::dvec3 from = camera_.eye;
    if (desired != glm::dvec3(0.0)) {
        const double pitch = follows_ground_ ? 0.0 : pitch_;
        const ViewAxes axes = view_axes(camera_from_angles(from, heading_, pitch, compass()));
        const glm::dvec3 ahead =
            view_axes(camera_from_angles(from, heading_, 0.0, compass())).forward;
        camera_.eye += desired.x * axes.right + desired.y * axes.forward + desired.z * up();
        if (height_) {
            *height_ = std::max(*height_ + desired.z, options_.clearance);
        }
        keep_above_ground();
        if (glm::distance(camera_.eye, from) < rounding) {
            camera_.eye = from; // held against the ground
        }
        if (options_.north && camera_.eye != from) {
            heading_ = heading_of(ahead, compass());
        }
    }
    if (step > 0.0) {
        keys_.forget_taps();
    }
    const bool turned = std::exchange(turned_, false);
    return turned || camera_.eye != from;
}

void FreeFlight::keep_above_ground() {
    const auto ground = options_.ground ? options_.ground(camera_.eye) : std::nullopt;
    if (!ground) {
        height_.reset();
        return;
    }
    if (!follows_ground_ || !height_) {
        height_ = std::max(ground->height, options_.clearance);
    }
    const double height = std::max(*height_, ground->highest + options_.clearance);
    camera_.eye += (height - ground->height) * up();
}

} // namespace reljef::scene
