#include "app/viewer/navigation.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace reljef::app {
namespace {

constexpr double distance_per_wheel_step = 0.8;
constexpr double degrees_per_pixel = 0.25; // of an orbit
constexpr double turn_per_pixel = 0.15;    // degrees
constexpr double min_drag = 3.0;           // pixels; less is a click
constexpr double still_after = 0.25;       // seconds
constexpr double seconds_closer = 0.8;
constexpr double seconds_of_flight = 1.5;
constexpr double arc_of_flight = 0.25;

} // namespace

std::optional<scene::Camera> Navigation::receive(const Event& event, const scene::Camera& camera) {
    if (const auto* resize = std::get_if<ResizeEvent>(&event)) {
        options_.world.size = glm::max(resize->framebuffer, glm::ivec2(1));
    }
    if (const auto* focus = std::get_if<FocusEvent>(&event); focus != nullptr && !focus->focused) {
        drag_.reset();
    }
    if (const auto* button = std::get_if<MouseButtonEvent>(&event)) {
        pointer_ = button->position;
        return button->pressed ? press(*button, camera) : release(*button);
    }
    if (const auto* move = std::get_if<MouseMoveEvent>(&event)) {
        return drag(move->position, camera);
    }
    if (const auto* wheel = std::get_if<ScrollEvent>(&event)) {
        return scroll(*wheel, camera);
    }
    return std::nullopt;
}

std::optional<glm::dvec3> Navigation::ground_at(const scene::Camera& camera,
                                                glm::dvec2 pixel) const {
    return options_.pick(scene::view_ray(camera, options_.world.size, pixel));
}

std::optional<scene::Camera> Navigation::press(const MouseButtonEvent& event,
                                               const scene::Camera& camera) {
    if (event.button == MouseButton::other || drag_) {
        return std::nullopt;
    }
    flight_.reset();
    const auto point = ground_at(camera, event.position);
    if (event.button == MouseButton::left && event.clicks == 2) {
        click_.reset();
        if (point) {
            flight_ = Flight{{camera,
                              scene::closer_to(camera, *point, options_.world),
                              {.seconds = seconds_closer}}};
        }
        return std::nullopt;
    }
    drag_ = Drag{event.button, event.position, point, camera};
    return std::nullopt;
}

std::optional<scene::Camera> Navigation::release(const MouseButtonEvent& event) {
    if (drag_ && drag_->button == event.button) {
        if (!drag_->has_moved && event.button == MouseButton::left) {
            click_ = event.position;
        }
        drag_.reset();
    }
    return std::nullopt;
}

std::optional<scene::Camera> Navigation::drag(glm::dvec2 to, const scene::Camera& camera) {
    const glm::dvec2 before = std::exchange(pointer_, to).value_or(to);
    if (!drag_) {
        return std::nullopt;
    }
    if (!drag_->has_moved) {
        if (!(glm::distance(to, drag_->from) >= min_drag)) {
            return std::nullopt;
        }
        drag_->has_moved = true;
    }
    const glm::dvec2 way = to - before;
    const scene::ViewAngles turn{turn_per_pixel * way.x, -turn_per_pixel * way.y};
    if (drag_->button == MouseButton::right && drag_->point) {
        const auto panned = scene::panned(drag_->camera, {*drag_->point, to}, options_.world);
        const bool is_stuck = panned == drag_->camera; // the pointer left the ground
        return moved(camera, is_stuck ? camera : panned);
    }
    if (drag_->button == MouseButton::left && drag_->point) {
        const scene::ViewAngles around{degrees_per_pixel * way.x, -degrees_per_pixel * way.y};
        return moved(camera,
                     scene::orbited(camera, {*drag_->point, drag_->from}, around, options_.world));
    }
    return moved(camera, scene::turned(camera, turn, options_.world));
}

std::optional<scene::Camera> Navigation::scroll(const ScrollEvent& event,
                                                const scene::Camera& camera) {
    const double factor = std::pow(distance_per_wheel_step, event.offset.y);
    if (!(factor > 0.0) || !std::isfinite(factor)) {
        return std::nullopt;
    }
    flight_.reset();
    const glm::dvec2 pixel = pointer_.value_or(0.5 * glm::dvec2(options_.world.size));
    const Ray ray = scene::view_ray(camera, options_.world.size, pixel);
    const auto point = options_.pick(ray);
    const double far = glm::distance(camera.eye, options_.middle) / glm::length(ray.direction);
    return moved(camera, scene::zoomed(camera, {point.value_or(ray.at(far)), pixel}, factor,
                                       options_.world));
}

std::optional<scene::Camera> Navigation::moved(const scene::Camera& from, const scene::Camera& to) {
    const double away = glm::distance(to.eye, options_.middle);
    const bool is_lost =
        away > options_.world.max_distance && away > glm::distance(from.eye, options_.middle);
    if (to == from || is_lost) {
        return std::nullopt;
    }
    rest_ = still_after;
    return to;
}

void Navigation::fly_to(const scene::Camera& from, const scene::Camera& to) {
    let_go();
    flight_ = Flight{{from, to, {.seconds = seconds_of_flight, .arc = arc_of_flight}}};
}

std::optional<scene::Camera> Navigation::advance(double seconds) {
    rest_ = std::max(0.0, rest_ - std::max(0.0, seconds));
    if (!flight_) {
        return std::nullopt;
    }
    flight_->time += std::max(0.0, seconds);
    const scene::Camera camera = flight_->way.at(flight_->time, options_.world);
    if (flight_->time >= flight_->way.seconds()) {
        flight_.reset();
    }
    return camera;
}

void Navigation::let_go() {
    drag_.reset();
    flight_.reset();
}

} // namespace reljef::app
