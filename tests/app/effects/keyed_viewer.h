#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <thread>
#include <variant>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "app/viewer/viewer.h"
#include "tests/app/made_hill.h"
#include "tests/support/temporary_folder.h"

namespace reljef::app {

inline constexpr glm::ivec2 keyed_window{400, 300};
inline constexpr glm::dvec2 on_ground_in_picture{180.0, 220.0};
inline constexpr double keyed_step = 1.0 / 60.0;

inline session::SceneOptions from_the_south() {
    session::SceneOptions view;
    view.eye = glm::dvec3(0.0, -300.0, 200.0);
    view.target = glm::dvec3(0.0, 0.0, 10.0);
    view.size = keyed_window;
    return view;
}

/// The current folder until the object ends.
class WorkingFolder {
public:
    explicit WorkingFolder(const std::filesystem::path& folder)
        : before_(std::filesystem::current_path()) {
        std::filesystem::current_path(folder);
    }
    ~WorkingFolder() { std::filesystem::current_path(before_); }
    WorkingFolder(const WorkingFolder&) = delete;
    WorkingFolder& operator=(const WorkingFolder&) = delete;

private:
    std::filesystem::path before_;
};

/// A viewer on a hill, in an empty folder.
struct KeyedViewer {
    void press(Key key, Modifiers modifiers = {}) {
        viewer.receive(KeyEvent{.key = key, .pressed = true, .modifiers = modifiers});
        viewer.receive(KeyEvent{.key = key, .pressed = false, .modifiers = modifiers});
    }
    /// How far a held key moves the eye: to the right, ahead and up.
    glm::dvec3 way_of(Key key, Modifiers modifiers = {}) {
        const scene::Camera before = camera();
        const scene::ViewAxes axes = scene::view_axes(before);
        viewer.receive(KeyEvent{.key = key, .pressed = true, .modifiers = modifiers});
        for (int i = 0; i < 5; ++i) {
            viewer.advance(keyed_step);
        }
        viewer.receive(KeyEvent{.key = key, .pressed = false});
        const glm::dvec3 way = camera().eye - before.eye;
        return {glm::dot(way, axes.right), glm::dot(way, axes.forward), way.z};
    }
    void drag(MouseButton button, glm::dvec2 by) {
        const glm::dvec2 from = on_ground_in_picture;
        viewer.receive(MouseMoveEvent{from});
        viewer.receive(MouseButtonEvent{.button = button, .pressed = true, .position = from});
        viewer.receive(MouseMoveEvent{from + by});
        viewer.receive(MouseButtonEvent{.button = button, .pressed = false, .position = from + by});
        viewer.advance(keyed_step);
    }
    void click() { drag(MouseButton::left, {0.0, 0.0}); }
    void settle() {
        viewer.advance(keyed_step);
        while (viewer.is_preparing()) {
            std::this_thread::sleep_for(
                std::chrono::milliseconds(1)); // leaves the work a processor
            viewer.advance(keyed_step);
        }
    }
    void choose_relief() {
        ASSERT_TRUE(viewer.act(ChooseTechnique{scene::Technique{scene::Relief{}}, {}}));
    }
    [[nodiscard]] scene::Relief relief() const {
        return std::get<scene::Relief>(viewer.technique().parameters);
    }
    [[nodiscard]] scene::Camera camera() const { return *scene.camera->get<scene::Camera>(); }
    [[nodiscard]] glm::dvec3 forward() const { return scene::view_axes(camera()).forward; }
    std::string notes() {
        struct Kept : session::Log {
            void message(session::MessageKind /*kind*/, std::string_view sentence) override {
                text += std::string(sentence) + '\n';
            }
            std::string text;
        } log;
        viewer.relay_to(log);
        return log.text;
    }
    static bool has_file(const char* name) { return std::filesystem::exists(name); }

    test::TemporaryFolder folder;
    WorkingFolder in_folder{folder.path()};
    session::TerrainScene scene = hill_scene(from_the_south());
    Viewer viewer{scene,
                  scene::orbit_path(scene.bounds, 10.0),
                  keyed_window,
                  {.maps = {}, .terrain = "hill.tif", .bookmarks = folder.path() / "marks.txt"}};
};

} // namespace reljef::app
