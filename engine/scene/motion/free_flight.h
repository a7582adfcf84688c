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
/// and shift. A key that was tapped counts as held until forget_taps(), so that none is lost in a
/// slow frame.
class SteeringKeys {
public:
    /// Says whether the key is one of them. With control, alt or super it is not, but for its
    /// release.
    bool receive(const KeyEvent& event);
    void release_all();
    void forget_taps() { tapped_.clear(); }

    /// To the right, ahead and up; of length 1, or zero.
    [[nodiscard]] glm::dvec3 direction() const;
    [[nodiscard]] bool is_fast() const { return is_down(Key::shift); }

private:
    [[nodiscard]] bool is_down(Key key) const {
        return held_.contains(key) || tapped_.contains(key);
    }

    std::set<Key> held_;
    std::set<Key> tapped_; // since forget_taps()
};

/// The ground at a place, world metres.
struct GroundAt {
    double height = 0.0;  ///< z of the surface
    double highest = 0.0; ///< z that nothing drawn there exceeds, at least `height`
};

struct FreeFlightOptions {
    double speed = 100.0;   ///< metres a second at first
    double clearance = 2.0; ///< metres that the eye stays above the highest that is drawn below it
    /// Nothing where there is no ground; absent: nowhere.
    std::function<std::optional<GroundAt>(double x, double y)> ground;
    /// Unit vector away from the Earth; absent: z.
    std::function<glm::dvec3(glm::dvec3 world)> up;
    /// Unit vector towards north at a place, level there; absent: y.
    std::function<glm::dvec3(glm::dvec3 world)> north;
};

/// A camera flown by hand: the mouse (left button held) turns, the steering keys move, the wheel
/// changes the speed, shift is four times as fast. The eye keeps its height above the ground until
/// it is told to rise or sink; without follow_ground it flies where it looks. It is never under the
/// ground. It goes straight on, over a pole too: what changes on the way is the heading.
class FreeFlight {
public:
    FreeFlight(const Camera& start, FreeFlightOptions options);

    /// Takes the events it knows and says whether it did.
    bool receive(const Event& event);

    /// Moves on by `seconds` (clamped to [0, 0.25]: a stall is no leap; not a number: 0). Returns
    /// whether the camera changed since the last call.
    bool advance(double seconds);

    /// Whether the next advance() may change the camera.
    [[nodiscard]] bool is_steered() const;
    /// As if all keys and buttons were released.
    void let_go();

    /// Turns with every move of the mouse, not only with the button held.
    void set_mouse_look(bool on);
    void set_follow_ground(bool on);
    [[nodiscard]] bool follows_ground() const { return follows_ground_; }

    /// Takes over from elsewhere, such as a fly path.
    void set_camera(const Camera& camera);
    [[nodiscard]] Camera camera() const;
    [[nodiscard]] double speed() const { return speed_; } ///< metres a second

private:
    bool receive_move(const MouseMoveEvent& event);
    bool receive_scroll(const ScrollEvent& event);
    [[nodiscard]] glm::dvec3 up() const;
    [[nodiscard]] Compass compass() const;
    [[nodiscard]] double heading_of(glm::dvec3 direction) const;
    void keep_above_ground();

    FreeFlightOptions options_;
    Camera camera_;
    double heading_ = 0.0; // degrees clockwise from north
    double pitch_ = 0.0;   // degrees above the horizon
    double speed_;
    bool follows_ground_ = true;
    std::optional<double> height_; // metres above the ground, where there is any
    SteeringKeys keys_;
    bool mouse_look_ = false;
    bool button_held_ = false;
    bool turned_ = false;
    std::optional<glm::dvec2> pointer_;
};

} // namespace reljef::scene
