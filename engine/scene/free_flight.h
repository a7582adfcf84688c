#pragma once

#include <functional>
#include <optional>
#include <set>

#include <glm/vec2.hpp>

#include "engine/core/event.h"
#include "engine/scene/camera.h"

namespace reljef::scene {

/// A camera flown by hand: the mouse (left button held) turns, W A S D or the arrows move, Q and E (or
/// page down and up) sink and rise, the wheel changes the speed, shift is four times as fast. The eye
/// stays at least `clearance` metres above the ground.
class FreeFlight {
public:
    /// `ground` gives z of the surface at x, y; nothing where there is none.
    FreeFlight(Camera start, double speed, double clearance,
               std::function<std::optional<double>(double x, double y)> ground);

    /// Takes the events it knows and says whether it did.
    bool receive(const Event& event);

    /// Moves on by `seconds` (clamped to [0, 0.25]: a stall is no leap). Returns whether anything moved.
    bool advance(double seconds);

    /// Turns with every move of the mouse, not only with the button held.
    void set_mouse_look(bool on);

    /// Takes over from elsewhere, such as a fly path.
    void set_camera(const Camera& camera);
    [[nodiscard]] Camera camera() const;
    [[nodiscard]] double speed() const { return speed_; } ///< metres a second

private:
    bool receive_key(const KeyEvent& event);
    bool receive_move(const MouseMoveEvent& event);
    [[nodiscard]] glm::dvec3 wanted_direction() const;
    void keep_above_ground();

    Camera camera_;
    double heading_ = 0.0; // degrees clockwise from north
    double pitch_ = 0.0;   // degrees above the horizon
    double speed_;
    double clearance_;
    std::function<std::optional<double>(double, double)> ground_;
    std::set<Key> held_;
    bool mouse_look_ = false;
    bool button_held_ = false;
    bool turned_ = false;
    std::optional<glm::dvec2> pointer_;
};

} // namespace reljef::scene
