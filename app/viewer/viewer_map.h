#pragma once

#include <optional>
#include <utility>

#include <glm/vec2.hpp>

#include "engine/core/event.h"
#include "engine/core/geometry.h"
#include "engine/scene/graph/camera.h"
#include "engine/scene/motion/free_flight.h"

namespace reljef::app {

/// An orthographic camera that moves like a map. Dragging with any button, W A S D and the arrows
/// shift it. The wheel and a double click zoom at the pointer, Q and E at the middle. Shift is four
/// times as fast. The target stays within half a terrain around the terrain.
class ViewerMap {
public:
    /// Precondition: `start` is orthographic. `size` is the picture's, pixels.
    ViewerMap(const scene::Camera& start, const Box& terrain, glm::ivec2 size);

    /// Returns whether it used the event.
    bool receive(const Event& event);
    /// Advances by `seconds`, clamped to [0, 0.25]. Returns whether the camera changed since the
    /// last call.
    bool advance(double seconds);
    /// Whether the next advance() may change the camera.
    [[nodiscard]] bool is_steered() const {
        return changed_ || keys_.direction() != glm::dvec3(0.0);
    }

    [[nodiscard]] const scene::Camera& camera() const { return camera_; }
    /// The place of a click of the left button since the last call, pixels.
    std::optional<glm::dvec2> take_click() { return std::exchange(click_, std::nullopt); }

private:
    bool receive_button(const MouseButtonEvent& event);
    bool receive_move(const MouseMoveEvent& event);
    void shift(glm::dvec2 metres);
    void zoom(double factor, glm::dvec2 pixel);
    [[nodiscard]] double metres_per_pixel() const { return camera_.view_height / size_.y; }

    scene::Camera camera_;
    Box reach_; // of the target
    double widest_;
    glm::dvec2 size_;
    scene::SteeringKeys keys_;
    bool dragged_ = false;
    bool changed_ = false;
    std::optional<glm::dvec2> pointer_;
    glm::dvec2 pressed_{0.0}; // where a button was pressed last
    std::optional<glm::dvec2> click_;
};

/// The whole terrain from straight above, north up.
scene::Camera whole_map(const Box& terrain, glm::ivec2 size);

} // namespace reljef::app
