#pragma once

#include <optional>
#include <string>

#include "app/scene_setup.h"
#include "engine/core/event.h"
#include "engine/render/frame_stats.h"
#include "engine/scene/fly_path.h"
#include "engine/scene/free_flight.h"

namespace reljef::app {

/// What each key does, for people: one line a key.
std::string viewer_keys();

/// Everything the viewer decides, without a window: takes events, moves the camera of its scene, and
/// says whether there is something new to draw.
class Viewer {
public:
    /// Precondition: `scene` outlives the viewer.
    Viewer(TerrainScene& scene, scene::FlyPath path);

    /// Takes an event; what it asks of the window is found in the requests below.
    void receive(const Event& event);
    /// Moves on by `seconds` (negative and not finite: none).
    void advance(double seconds);

    /// Flies along the path, or stops.
    void toggle_path();

    /// Whether the scene changed since the last call.
    bool take_redraw();
    /// Whether something moves by itself, so that the next frame will differ.
    [[nodiscard]] bool is_moving() const { return playing_ || moving_; }

    bool take_screenshot_request();
    bool take_help_request();
    [[nodiscard]] bool wants_to_close() const { return close_; }
    [[nodiscard]] bool wants_mouse() const { return mouse_look_; }
    [[nodiscard]] bool is_playing() const { return playing_; }
    [[nodiscard]] bool is_map() const { return before_map_.has_value(); }

    /// Name, technique, triangles, frame rate and where the eye is, for the window's title.
    [[nodiscard]] std::string title(const render::FrameStats& stats, double frame_ms) const;

private:
    using Action = void (Viewer::*)();
    struct Binding;

    bool receive_key(const KeyEvent& event);
    void toggle_map();
    void toggle_wireframe();
    void toggle_mouse_look();
    void next_technique();
    void choose_technique(std::size_t index);
    void ask_for_screenshot();
    void ask_for_help();
    void leave();
    void show_camera(const scene::Camera& camera);
    [[nodiscard]] scene::Camera& camera() { return *scene_.camera->get<scene::Camera>(); }

    TerrainScene& scene_;
    scene::FlyPath path_;
    scene::FreeFlight flight_;
    std::optional<scene::Camera> before_map_;
    double path_time_ = 0.0;
    bool playing_ = false;
    bool moving_ = false;
    bool mouse_look_ = false;
    bool redraw_ = true;
    bool screenshot_ = false;
    bool help_ = false;
    bool close_ = false;
};

/// The first name reljef-0001.png, reljef-0002.png, … that does not exist in `folder`.
std::filesystem::path next_screenshot(const std::filesystem::path& folder);

} // namespace reljef::app
