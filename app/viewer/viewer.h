#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>

#include "app/viewer/appearance/appearance_switch.h"
#include "app/viewer/appearance/contour_watch.h"
#include "app/viewer/appearance/level_switch.h"
#include "app/viewer/appearance/proof_switch.h"
#include "app/viewer/appearance/surface_switch.h"
#include "app/viewer/appearance/technique_editor.h"
#include "app/viewer/comparing/comparison.h"
#include "app/viewer/measuring.h"
#include "app/viewer/navigation.h"
#include "app/viewer/panels/panel_action.h"
#include "app/viewer/panels/panel_content.h"
#include "app/viewer/paths/path_desk.h"
#include "app/viewer/places/bookmarks.h"
#include "app/viewer/viewer_map.h"
#include "engine/core/event.h"
#include "engine/scene/motion/camera_path.h"
#include "engine/scene/motion/free_flight.h"
#include "engine/scene/technique/technique.h"
#include "engine/session/ground.h"
#include "engine/session/scene_setup.h"
#include "engine/view/frame_stats.h"

namespace reljef::app {

struct FrameTiming {
    double last_ms = 0.0;                    ///< of the last frame
    std::optional<double> frames_per_second; ///< absent at rest
    int divisor = 1;                         ///< of the window's sides
};

struct ViewerOptions {
    AppearanceSwitchOptions maps;
    bool allow_underground = false; ///< the ground does not stop the camera
    bool proves_errors = false;     ///< of a streamed terrain, see ProofSwitch
    std::string terrain;            ///< as on the command line, for bookmarks
    std::optional<std::filesystem::path>
        bookmarks; ///< their file; absent: there is no place for it
};

/// The viewer's logic without a window. It receives events and moves the scene's camera.
class Viewer {
public:
    /// Precondition: make_scene() made `scene`, which outlives the viewer. `size` of the picture,
    /// pixels.
    Viewer(session::TerrainScene& scene, scene::CameraPath path, glm::ivec2 size,
           const ViewerOptions& options = {});

    /// The keys and what they do.
    static std::vector<KeyContent> key_list();
    /// The same as lines of text.
    static std::string keys();

    void receive(const Event& event);
    /// Advances by `seconds`; negative or not finite values count as 0. The first step after rest
    /// is at most a frame long.
    void advance(double seconds);

    /// The expected cameras of the next seconds; empty at rest.
    [[nodiscard]] std::vector<scene::Camera> upcoming() const;

    void toggle_path();

    /// Flies smoothly to a view, and leaves the map for it.
    void fly_to(const scene::Camera& camera);
    /// Saves the current view under a name, or under its place if that is empty.
    Result<void> save_bookmark(const std::string& name);
    /// The bookmarks of this terrain.
    [[nodiscard]] Result<BookmarkContent> bookmarks() const;
    /// The same as of the last action on them.
    [[nodiscard]] const BookmarkContent& known_bookmarks() const { return known_bookmarks_; }
    Result<void> go_to_bookmark(const Bookmark& bookmark);
    Result<void> rename_bookmark(const Bookmark& bookmark, const std::string& name);
    Result<void> remove_bookmark(const Bookmark& bookmark);
    /// The options that show this view again; fails on the map, which has none.
    [[nodiscard]] Result<std::string> camera_options() const;

    /// Points on the ground and on objects; while it is on, each click picks one.
    [[nodiscard]] Measuring& measuring() { return measuring_; }
    [[nodiscard]] const Measuring& measuring() const { return measuring_; }
    /// Writes the profile, or begins the viewshed, under a free name in the current folder.
    Result<void> save_profile();
    Result<void> begin_viewshed();
    /// Whether the ground has the colours of the last viewshed, or gets them.
    [[nodiscard]] bool shows_viewshed() const { return surface_switch_.overlay() != nullptr; }

    /// What the right part of the window shows.
    [[nodiscard]] Comparison& comparison() { return comparison_; }
    [[nodiscard]] const Comparison& comparison() const { return comparison_; }

    /// The path, to edit and save it.
    [[nodiscard]] PathDesk& path_desk() { return desk_; }
    [[nodiscard]] const PathDesk& path_desk() const { return desk_; }
    [[nodiscard]] double path_time() const { return path_time_; } ///< seconds since its beginning
    /// Shows the path's view at a time since its beginning, seconds; stops.
    void seek(double seconds);
    void toggle_recording();
    Result<void> save_path();
    // What panels ask for. Failures change nothing.
    Result<void> act(const ChooseTechnique& choice) { return request(choice); }
    Result<void> act(const SelectModel& choice);
    Result<void> act(const SelectParameter& choice);
    Result<void> act(const SetSun& sun);
    Result<void> act(const SetTurbidity& set);
    Result<void> act(const SetGrain& set);
    Result<void> act(const SetContours& set);
    Result<void> act(const SetContourLabels& set);
    Result<void> act(const SetEyeDome& set);
    Result<void> act(const SetVisibility& set);
    Result<void> act(const SetRamp& set);
    Result<void> act(const SetImageryShare& set);
    Result<void> act(const SetExaggeration& set);
    Result<void> act(const SetComparison& set) { return comparison_.set(set.with); }
    Result<void> act(const SetOtherTechnique& set) { return comparison_.choose(set.technique); }
    Result<void> act(const SetWipe& set);
    Result<void> act(const SwapTechniques& action);
    Result<void> act(const SeekPath& seek);
    Result<void> act(const InsertPathKey& insert);
    Result<void> act(const MovePathKey& move);
    Result<void> act(const RetimePathKey& retime);
    Result<void> act(const RemovePathKey& remove);
    Result<void> act(const SetPathDuration& set);
    Result<void> act(const ClearPoints& action);
    Result<void> act(const AddBookmark& add) { return save_bookmark(add.name); }
    Result<void> act(const GoToBookmark& go) { return go_to_bookmark(go.bookmark); }
    Result<void> act(const RenameBookmark& rename) {
        return rename_bookmark(rename.bookmark, rename.name);
    }
    Result<void> act(const RemoveBookmark& remove) { return remove_bookmark(remove.bookmark); }
    Result<void> act(const SetSpeed& set);
    Result<void> act(const ShowViewshed& set);

    /// Whether the scene changed since the last call; true at first.
    bool take_redraw() { return std::exchange(redraw_, false); }
    /// Whether the panels show something new of a scene that is as it was.
    bool take_content_change() { return std::exchange(content_changed_, false); }
    /// Whether the view moves by itself or is steered.
    [[nodiscard]] bool is_moving() const;

    bool take_video_request() { return std::exchange(video_, false); }
    /// Fails if the technique cannot draw what it is chosen for.
    Result<void> request(const ChooseTechnique& choice);
    void set_sun(const SetSun& sun);
    [[nodiscard]] const terrain::ColorRamp& ramp() const { return surface_switch_.ramp(); }
    [[nodiscard]] double imagery_share() const { return surface_switch_.imagery_share(); }
    /// See SurfaceSwitch::request(). The eye stays unless the ground rises above it.
    void refine(std::shared_ptr<const terrain::Terrain> finer) {
        surface_switch_.request(std::move(finer));
    }
    void set_exaggeration(double factor) { surface_switch_.request(factor); }
    [[nodiscard]] TechniqueEditor& techniques() { return techniques_; }
    [[nodiscard]] const TechniqueEditor& techniques() const { return techniques_; }
    [[nodiscard]] const scene::Technique& technique() const { return switch_.technique(); }
    [[nodiscard]] const scene::Light& light() const { return switch_.light(); }
    [[nodiscard]] double exaggeration() const { return surface_switch_.factor(); }
    [[nodiscard]] std::string exaggeration_obstacle() const { return surface_switch_.obstacle(); }
    /// Whether the models have the techniques with which the scene was opened.
    [[nodiscard]] bool keeps_techniques() const;
    /// The ground or object that a pixel shows; empty over the sky and in the gallery.
    [[nodiscard]] std::optional<session::PickedPlace> place_at_pixel(glm::dvec2 pixel) const;
    /// Degrees clockwise from north, [0, 360); empty outside the map's domain.
    [[nodiscard]] std::optional<double> heading() const;
    [[nodiscard]] double speed() const { return flight_.speed(); } ///< metres a second
    [[nodiscard]] bool follows_ground() const { return flight_.follows_ground(); }
    /// Of background work; its label is empty if there is none.
    [[nodiscard]] session::RelayedLog::TaskProgress progress() const;

    bool take_command_request() { return std::exchange(command_, false); }
    bool take_screenshot_request() { return std::exchange(screenshot_, false); }
    bool take_help_request() { return std::exchange(help_, false); }
    /// Text for the clipboard since the last call.
    std::optional<std::string> take_clipboard() { return std::exchange(clipboard_, std::nullopt); }
    /// Lines for standard output since the last call; empty: none.
    std::string take_output() { return std::exchange(output_, {}); }
    [[nodiscard]] bool wants_to_close() const { return close_; }
    [[nodiscard]] bool wants_mouse() const { return mouse_look_; }
    [[nodiscard]] bool is_playing() const { return playing_; }
    /// How far the ground lifted the path at most, metres.
    [[nodiscard]] double path_lifted() const { return path_lifted_; }
    [[nodiscard]] bool is_map() const { return map_.has_value(); }
    /// Why the contours of the view are not seen; empty: they are, or there are none.
    [[nodiscard]] const std::string& faded_contours() const { return contours_.sentence(); }
    // As in AppearanceSwitch.
    [[nodiscard]] bool is_preparing() const {
        return switch_.is_preparing() || surface_switch_.is_preparing();
    }
    void relay_to(session::Log& log);
    bool undo_technique();
    std::shared_ptr<const view::PreparedLight> take_light();

    [[nodiscard]] std::string title(const view::FrameStats& stats, const FrameTiming& timing) const;

private:
    struct Binding;
    static std::span<const Binding> bindings();

    bool receive_key(const KeyEvent& event);
    void leave_measured_ground();
    void update_appearance();
    void move(double step);
    void advance_path(double seconds);
    void show_path(); // at path_time_
    bool receive_mouse(const Event& event);
    void steer(const scene::Camera& camera);
    Result<void> set_path(Result<scene::CameraPath> path);
    void report(const Result<void>& result);
    void receive_click();
    void toggle_measuring();
    void toggle_comparison() { report(comparison_.toggle()); }
    void next_comparison() { report(comparison_.next()); }
    void next_other_technique() { comparison_.choose_next(); }
    void move_line_left() { comparison_.move_line(-1); }
    void move_line_right() { comparison_.move_line(1); }
    void append_key();
    void remove_key();
    void keep_path() { report(save_path()); }
    void keep_profile() { report(save_profile()); }
    void keep_viewshed() { report(begin_viewshed()); }
    void toggle_viewshed() { report(act(ShowViewshed{!shows_viewshed()})); }
    void ask_for_video();
    void read_bookmarks();
    void bookmark_here() { report(save_bookmark({})); }
    void next_bookmark();
    void copy_camera();
    void go_to_start();
    void toggle_map();
    void toggle_wireframe();
    void turn_light();
    void toggle_mouse_look();
    void toggle_follow_ground() { flight_.set_follow_ground(!flight_.follows_ground()); }
    void next_technique();
    void choose_technique(std::size_t index);
    void step_parameter(int steps);
    void change_technique(const std::function<void()>& change);
    void select_parameter(int steps);
    void restore_techniques();
    void raise_parameter() { step_parameter(1); }
    void lower_parameter() { step_parameter(-1); }
    void next_parameter() { select_parameter(1); }
    void last_parameter() { select_parameter(-1); }
    void ask_for_command() { command_ = true; }
    void ask_for_screenshot() { screenshot_ = true; }
    void ask_for_help() { help_ = true; }
    void leave();
    void show_camera(const scene::Camera& camera);
    [[nodiscard]] std::string place() const;
    [[nodiscard]] std::optional<session::PickedPlace> place_at(glm::dvec2 pixel) const;
    [[nodiscard]] const scene::Camera& camera() const {
        return *scene_.camera->get<scene::Camera>();
    }
    [[nodiscard]] const scene::Material& material() const { return *scene_.materials().front(); }

    session::TerrainScene& scene_;
    PathDesk desk_;
    glm::ivec2 size_;
    scene::Camera start_;
    std::vector<scene::Technique> start_techniques_; // of the materials
    AppearanceSwitch switch_;
    TechniqueEditor techniques_; // uses the switch
    SurfaceSwitch surface_switch_;
    LevelSwitch levels_;
    ContourWatch contours_;
    std::optional<ProofSwitch> proofs_;
    scene::FreeFlight flight_;
    Navigation navigation_;
    Measuring measuring_;
    Comparison comparison_;
    std::string terrain_;
    std::optional<Bookmarks> bookmarks_;
    BookmarkContent known_bookmarks_;
    std::size_t next_bookmark_ = 0;
    session::RelayedLog notes_;
    std::optional<std::string> clipboard_;
    std::string output_;
    std::optional<ViewerMap> map_; // while it is shown
    double path_time_ = 0.0;
    double path_lifted_ = 0.0;
    scene::Camera before_;   // the last step
    double last_step_ = 0.0; // seconds
    bool playing_ = false;
    bool rested_ = true; // nothing moved at the last advance()
    bool mouse_look_ = false;
    bool redraw_ = true;
    bool content_changed_ = false;
    bool screenshot_ = false;
    bool video_ = false;
    bool command_ = false;
    bool help_ = false;
    bool close_ = false;
    bool leaves_viewshed_ = false; // the user was asked
};

/// The first name STEM-0001, STEM-0002, … in `folder` that is free with each of the extensions.
std::filesystem::path next_stem(const std::filesystem::path& folder, const std::string& stem,
                                std::initializer_list<std::string_view> extensions);
/// The first free name STEM-0001EXTENSION, STEM-0002EXTENSION, … in `folder`.
std::filesystem::path next_file(const std::filesystem::path& folder, const std::string& stem,
                                const std::string& extension);
/// The first free name reljef-0001.png, reljef-0002.png, … in `folder`.
inline std::filesystem::path next_screenshot(const std::filesystem::path& folder) {
    return next_file(folder, "reljef", ".png");
}

} // namespace reljef::app
