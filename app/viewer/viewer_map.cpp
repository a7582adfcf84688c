#include "app/viewer/viewer_map.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/scene/motion/poses.h"

namespace reljef::app {
namespace {

constexpr double zoom_per_wheel_step = 1.25;
constexpr double zoom_per_second = 2.0;
constexpr double zoom_per_double_click = 2.0;
constexpr double min_way = 3.0; // pixels; less is a click
constexpr double pictures_per_second = 0.5;
constexpr double shift_factor = 4.0;
constexpr double longest_step = 0.25; // seconds
constexpr double widest_in_starts = 4.0;
constexpr double narrowest_in_starts = 1e-4;

// The terrain with a margin of half its size.
Box around(const Box& terrain) {
    const glm::dvec3 size = terrain.size();
    const glm::dvec3 margin{0.5 * std::max({size.x, size.y, size.z})};
    return {terrain.low - margin, terrain.high + margin};
}

} // namespace

ViewerMap::ViewerMap(const scene::Camera& start, const Box& terrain, glm::ivec2 size)
    : camera_(start), reach_(around(terrain)), widest_(start.view_height * widest_in_starts),
      size_(glm::max(size, glm::ivec2(1))) {
    reach_.add(start.target);
}

bool ViewerMap::receive(const Event& event) {
    if (const auto* key = std::get_if<KeyEvent>(&event)) {
        return keys_.receive(*key);
    }
    if (const auto* button = std::get_if<MouseButtonEvent>(&event)) {
        return receive_button(*button);
    }
    if (const auto* move = std::get_if<MouseMoveEvent>(&event)) {
        return receive_move(*move);
    }
    if (const auto* scroll = std::get_if<ScrollEvent>(&event)) {
        zoom(std::pow(zoom_per_wheel_step, -scroll->offset.y), pointer_.value_or(0.5 * size_));
        return true;
    }
    if (const auto* resize = std::get_if<ResizeEvent>(&event)) {
        size_ = glm::max(resize->framebuffer, glm::ivec2(1));
    }
    if (const auto* focus = std::get_if<FocusEvent>(&event); focus != nullptr && !focus->focused) {
        keys_.release_all();
        dragged_ = false;
    }
    return false;
}

// Every button drags, so that no habit of other programs fails; a double click comes closer.
bool ViewerMap::receive_button(const MouseButtonEvent& event) {
    if (event.button == MouseButton::other) {
        return false;
    }
    dragged_ = event.pressed;
    const bool is_click = event.button == MouseButton::left && !event.pressed &&
                          glm::distance(event.position, pressed_) < min_way;
    click_ = is_click ? std::optional(event.position) : click_;
    pressed_ = event.pressed ? event.position : pressed_;
    pointer_ = event.pressed ? event.position : pointer_.value_or(event.position);
    if (event.pressed && event.clicks == 2) {
        zoom(1.0 / zoom_per_double_click, event.position);
    }
    return true;
}

bool ViewerMap::receive_move(const MouseMoveEvent& event) {
    const auto before = std::exchange(pointer_, event.position);
    if (!before || !dragged_) {
        return false;
    }
    const glm::dvec2 moved = event.position - *before;
    shift(metres_per_pixel() * glm::dvec2(-moved.x, moved.y));
    return true;
}

bool ViewerMap::advance(double seconds) {
    const double step = seconds > 0.0 ? std::min(seconds, longest_step) : 0.0;
    const double pace = step * (keys_.is_fast() ? shift_factor : 1.0);
    const glm::dvec3 requested = pace * keys_.direction();
    if (requested != glm::dvec3(0.0)) {
        shift(pictures_per_second * camera_.view_height * glm::dvec2(requested));
        zoom(std::pow(zoom_per_second, requested.z), 0.5 * size_);
    }
    if (step > 0.0) {
        keys_.forget_taps();
    }
    return std::exchange(changed_, false);
}

void ViewerMap::shift(glm::dvec2 metres) {
    const scene::ViewAxes axes = scene::view_axes(camera_);
    const glm::dvec3 requested = camera_.target + metres.x * axes.right + metres.y * axes.up;
    if (!std::isfinite(metres.x) || !std::isfinite(metres.y)) {
        return;
    }
    const glm::dvec3 way = glm::clamp(requested, reach_.low, reach_.high) - camera_.target;
    camera_.target += way;
    camera_.eye += way;
    changed_ = changed_ || way != glm::dvec3(0.0);
}

void ViewerMap::zoom(double factor, glm::dvec2 pixel) {
    const double narrowest = widest_ / widest_in_starts * narrowest_in_starts;
    const double height = camera_.view_height * factor;
    if (std::isnan(height)) {
        return;
    }
    const double before =
        std::exchange(camera_.view_height, std::clamp(height, narrowest, widest_));
    changed_ = changed_ || camera_.view_height != before;
    const glm::dvec2 from_middle = glm::dvec2(1.0, -1.0) * (pixel - 0.5 * size_);
    shift((before - camera_.view_height) / size_.y * from_middle);
}

scene::Camera whole_map(const Box& terrain, glm::ivec2 size) {
    constexpr double margin = 1.02;
    scene::Camera camera =
        scene::pose_camera(scene::Pose::map, terrain, [](double, double) { return 0.0; });
    const glm::dvec2 picture(glm::max(size, glm::ivec2(1)));
    camera.view_height =
        margin * std::max(terrain.size().y, terrain.size().x * picture.y / picture.x);
    return camera;
}

} // namespace reljef::app
