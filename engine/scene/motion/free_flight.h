#pragma once

#include <functional>
#include <optional>
#include <set>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/event.h"
#include "engine/scene/graph/camera.h"

namespace reljef::scene {

/// The keys that steer: W S or up and down, A D or left and right, Q E or page down and page up,
/// and shift. A tapped key counts as held until forget_taps(), so that slow frames lose no key.
class SteeringKeys {
public:
    /// Returns whether it handled the key. Ignores keys pressed with control, alt or super.
    bool receive(const KeyEvent& event);
    void release_all();
    void forget_taps() { tapped_.clear(); }

    /// Right, ahead, up; of length 1, or zero.
    [[nodiscard]] glm::dvec3 direction() const;
    [[nodiscard]] bool is_fast() const { return is_down(Key::shift); }

private:
    [[nodiscard]] bool is_down(Key key) const {
        return held_.contains(key) || tapped_.contains(key);
    }

    std::set<Key> held_;
    std::set<Key> tapped_; // since forget_taps()
};

/// The ground below an eye, metres along the local vertical.
struct GroundBelow {
    double height = 0.0;  ///< of the eye above the surface; negative below it
    double highest = 0.0; ///< upper bound of everything drawn there, above the surface
};

struct FreeFlightOptions {
    double speed = 100.0;   ///< initial speed, metres a second
    double clearance = 2.0; ///< smallest height above GroundBelow::highest, metres
    /// Returns nothing where there is no ground; absent: there is none.
    std::function<std::optional<GroundBelow>(glm::dvec3 eye)> ground;
    /// Local vertical, a unit vector; absent: z.
    std::function<glm::dvec3(glm::dvec3 world)> up;
    /// Horizontal unit vector to the north; absent: y.
    std::function<glm::dvec3(glm::dvec3 world)> north;
};

/// A camera with manual control: the steering keys move, shift is four times as fast, mouse look
/// turns. The eye keeps its height above the ground
/// unless keys change it; without follow_ground it moves along the view. It is never below the
/// ground. It moves along great circles, even across a pole: the heading changes on the way.
class FreeFlight {
public:
    FreeFlight(const Camera& start, FreeFlightOptions options);

    /// Returns whether it handled the event.
    bool receive(const Event& event);

    /// Moves by `seconds`, clamped to [0, 0.25] (not a number: 0). Returns whether the camera
    /// changed since the last call.
    bool advance(double seconds);

    /// Whether the next advance() may change the camera.
    [[nodiscard]] bool is_steered() const;
    /// Releases all keys.
    void let_go();

    /// Turns with every move of the mouse.
    void set_mouse_look(bool on);
    /// Multiplies the speed by 1.25 for each step.
    void change_speed(double steps);
    /// Metres a second, clamped to what the flight allows; not a number changes nothing.
    void set_speed(double speed);
    void set_follow_ground(bool on) { follows_ground_ = on; }
    [[nodiscard]] bool follows_ground() const { return follows_ground_; }

    void set_camera(const Camera& camera);
    [[nodiscard]] Camera camera() const;
    [[nodiscard]] double speed() const { return speed_; } ///< metres a second

private:
    bool receive_move(const MouseMoveEvent& event);
    [[nodiscard]] glm::dvec3 up() const;
    [[nodiscard]] Compass compass() const;
    void keep_above_ground();

    FreeFlightOptions options_;
    Camera camera_;
    double heading_ = 0.0; // degrees clockwise from north
    double pitch_ = 0.0;   // degrees above the horizon
    double speed_;
    bool follows_ground_ = true;
    std::optional<double> height_; // metres above the ground; empty without ground
    SteeringKeys keys_;
    bool mouse_look_ = false;
    bool turned_ = false;
    std::optional<glm::dvec2> pointer_;
};

} // namespace reljef::scene
