#pragma once

#include <functional>
#include <optional>
#include <utility>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/event.h"
#include "engine/scene/motion/camera_gestures.h"
#include "engine/scene/motion/camera_transition.h"

namespace reljef::app {

struct NavigationOptions {
    scene::GestureWorld world;
    /// The ground or object that a ray meets first, world metres; empty: the sky.
    std::function<std::optional<glm::dvec3>(const Ray&)> pick;
    glm::dvec3 middle{0.0}; ///< of the terrain: the wheel in the sky moves as far as towards it
};

/// The mouse moves a perspective camera. The wheel zooms at the pointer. The left button orbits
/// around the ground under the pointer, the right one pans, the middle one turns; so does the left
/// one from the sky. A double click flies closer. A click without a move is kept for take_click().
class Navigation {
public:
    explicit Navigation(NavigationOptions options) : options_(std::move(options)) {}

    /// The camera after the event, if it moves the camera.
    std::optional<scene::Camera> receive(const Event& event, const scene::Camera& camera);
    /// Begins a flight to a camera; it ends with the next gesture or let_go().
    void fly_to(const scene::Camera& from, const scene::Camera& to);
    /// The camera of the flight after `seconds` more; empty without a flight.
    std::optional<scene::Camera> advance(double seconds);
    /// Ends the flight and the drag.
    void let_go();

    /// Whether the camera flies, or moved in the last quarter of a second.
    [[nodiscard]] bool is_moving() const { return flight_ || rest_ > 0.0; }
    /// The place of a click since the last call, pixels.
    std::optional<glm::dvec2> take_click() { return std::exchange(click_, std::nullopt); }
    [[nodiscard]] const scene::GestureWorld& world() const { return options_.world; }

private:
    struct Drag {
        MouseButton button = MouseButton::left;
        glm::dvec2 from{0.0};            // where the button was pressed, pixels
        std::optional<glm::dvec3> point; // the ground there
        scene::Camera camera;            // then
        bool has_moved = false;
    };
    struct Flight {
        scene::CameraTransition way;
        double time = 0.0;
    };

    [[nodiscard]] std::optional<glm::dvec3> ground_at(const scene::Camera& camera,
                                                      glm::dvec2 pixel) const;
    std::optional<scene::Camera> press(const MouseButtonEvent& event, const scene::Camera& camera);
    std::optional<scene::Camera> release(const MouseButtonEvent& event);
    std::optional<scene::Camera> drag(glm::dvec2 to, const scene::Camera& camera);
    std::optional<scene::Camera> scroll(const ScrollEvent& event, const scene::Camera& camera);
    std::optional<scene::Camera> moved(const scene::Camera& from, const scene::Camera& to);

    NavigationOptions options_;
    std::optional<glm::dvec2> pointer_;
    std::optional<Drag> drag_;
    std::optional<Flight> flight_;
    std::optional<glm::dvec2> click_;
    double rest_ = 0.0; // seconds until the camera counts as still
};

} // namespace reljef::app
