#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "app/viewer/appearance_switch.h"
#include "app/viewer/viewer_map.h"
#include "engine/core/event.h"
#include "engine/scene/motion/camera_path.h"
#include "engine/scene/motion/free_flight.h"
#include "engine/scene/technique/technique.h"
#include "engine/session/scene_setup.h"
#include "engine/view/frame_stats.h"

namespace reljef::app {

/// How fast pictures come.
struct FrameTiming {
    double last_ms = 0.0;                    ///< what the last picture took to draw
    std::optional<double> frames_per_second; ///< absent: nothing moves, nothing is drawn
    int divisor = 1;                         ///< of the window's sides, for fewer pixels
};

struct ViewerOptions {
    AppearanceSwitchOptions maps;
    bool allow_underground = false; ///< the ground stops nobody
};

/// What is shown of a scene until the maps of its techniques are made: levels by distance, which
/// need none. The scene's own technique if nothing is missing.
scene::Technique first_technique(const session::TerrainScene& scene);

/// Everything the viewer decides, without a window: takes events, moves the camera of its scene,
/// and says whether there is something new to draw.
class Viewer {
public:
    /// Precondition: `scene` is as make_scene() gives it and outlives the viewer. `size` is the
    /// picture's, pixels. While the maps of the scene's technique are made, a coarser one is shown.
    Viewer(session::TerrainScene& scene, scene::CameraPath path, glm::ivec2 size,
           const ViewerOptions& options = {});

    /// What each key does, for people: a line each.
    static std::string keys();

    /// Takes an event; what it asks of the window is found in the requests below.
    void receive(const Event& event);
    /// Moves on by `seconds` (negative and not finite: none). After standing still, the first step
    /// is no longer than a frame.
    void advance(double seconds);

    /// Where the camera is about to be in the next seconds, if it goes on as it does; nothing while
    /// it stands still.
    [[nodiscard]] std::vector<scene::Camera> upcoming() const;

    /// Flies along the path, or stops.
    void toggle_path();

    /// Whether the scene changed since the last call; at first it did.
    bool take_redraw();
    /// Whether something moves by itself or is steered, so that the next frame may differ.
    [[nodiscard]] bool is_moving() const;

    bool take_screenshot_request();
    bool take_help_request();
    [[nodiscard]] bool wants_to_close() const { return close_; }
    [[nodiscard]] bool wants_mouse() const { return mouse_look_; }
    [[nodiscard]] bool is_playing() const { return playing_; }
    /// By how many metres the path was kept above the ground at most, so far.
    [[nodiscard]] double path_raised() const { return path_raised_; }
    [[nodiscard]] bool is_map() const { return map_.has_value(); }
    /// Whether maps of a technique are being made; it is shown when they are there.
    [[nodiscard]] bool is_preparing() const { return switch_.is_preparing(); }
    /// What is being made, and how far it is.
    [[nodiscard]] session::RelayedLog::TaskProgress preparation() const {
        return switch_.progress();
    }
    /// Hands on what was reported since the last call.
    void relay_to(session::Log& log) { switch_.relay_to(log); }
    /// As AppearanceSwitch::undo().
    bool undo_technique();
    /// As AppearanceSwitch::take_light().
    std::shared_ptr<const render::PreparedLight> take_light() { return switch_.take_light(); }

    /// Name, technique, frame rate, triangles and where the eye is, for the window's title.
    [[nodiscard]] std::string title(const view::FrameStats& stats, const FrameTiming& timing) const;

private:
    struct Binding;
    static std::span<const Binding> bindings();

    bool receive_key(const KeyEvent& event);
    void advance_path(double seconds);
    void go_to_start();
    void toggle_map();
    void toggle_wireframe();
    void turn_light();
    void toggle_mouse_look();
    void toggle_follow_ground();
    void next_technique();
    void choose_technique(std::size_t index);
    void ask_for_screenshot() { screenshot_ = true; }
    void ask_for_help() { help_ = true; }
    void leave();
    void show_camera(const scene::Camera& camera);
    [[nodiscard]] std::string place() const;
    [[nodiscard]] const scene::Camera& camera() const {
        return *scene_.camera->get<scene::Camera>();
    }
    [[nodiscard]] const scene::Material& material() const;

    session::TerrainScene& scene_;
    scene::CameraPath path_;
    glm::ivec2 size_;
    scene::Camera start_;
    std::vector<scene::Technique> techniques_; // as asked for, in the catalogue's order
    AppearanceSwitch switch_;
    scene::FreeFlight flight_;
    std::optional<ViewerMap> map_; // while it is shown
    double path_time_ = 0.0;
    double path_raised_ = 0.0;
    scene::Camera before_;   // the last step
    double last_step_ = 0.0; // seconds
    bool playing_ = false;
    bool rested_ = true; // nothing moved at the last advance()
    bool mouse_look_ = false;
    bool redraw_ = true;
    bool screenshot_ = false;
    bool help_ = false;
    bool close_ = false;
};

/// The first name reljef-0001.png, reljef-0002.png, … that nothing in `folder` has.
std::filesystem::path next_screenshot(const std::filesystem::path& folder);

} // namespace reljef::app
