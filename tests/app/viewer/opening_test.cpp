#include "app/viewer/opening.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace reljef::app {
namespace {

// Remembers its titles.
class TitledWindow : public platform::Window {
public:
    platform::Context& context() override { throw std::logic_error("no context is needed"); }
    [[nodiscard]] bool should_close() const override { return false; }
    std::vector<Event> wait_events(std::chrono::milliseconds /*timeout*/) override {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return {};
    }
    [[nodiscard]] glm::ivec2 framebuffer_size() const override { return {64, 48}; }
    [[nodiscard]] double content_scale() const override { return 1.0; }
    void set_title(const std::string& title) override { titles.push_back(title); }
    void swap_buffers() override {}
    void set_clipboard(const std::string& /*text*/) override {}
    void capture_mouse(bool /*on*/) override {}
    [[nodiscard]] std::string clipboard() const override { return {}; }

    std::vector<std::string> titles;
};

// A display answers a title with an event, which ends the wait for events.
TEST(Opening, SetsNoTitleAgain) {
    TitledWindow window;
    session::Log silent;
    session::SourceOptions terrain;
    terrain.terrain = "natural";
    Opening opening(terrain, session::SceneOptions{});
    opening.begin(session::RayUse::none, 4096);
    const auto opened = opening.finish(window, silent, std::stop_source());
    ASSERT_TRUE(opened) << opened.error().message;
    ASSERT_TRUE(opened->has_value());
    ASSERT_FALSE(window.titles.empty());
    EXPECT_EQ(std::adjacent_find(window.titles.begin(), window.titles.end()), window.titles.end());
}

// A large file is shown at once, but for a camera that stands on its ground.
TEST(Opening, BeginsWithFewerSamplesOfALargeFile) {
    const test::TemporaryFolder folder;
    constexpr int side = 1201;
    std::string heights(std::size_t{2} * side * side, '\0');
    for (std::size_t i = 0; i < heights.size(); i += 2) {
        heights[i] = static_cast<char>(i / side / 300); // big-endian
    }
    folder.write("N45E006.hgt", heights);
    session::SourceOptions terrain;
    terrain.terrain = (folder.path() / "N45E006.hgt").string();
    session::SceneOptions over_a_place;
    over_a_place.geodetic = session::GeodeticView{45.5, 6.5, 3000.0, 0.0, -10.0};
    session::Log silent;
    for (const session::SceneOptions& view : {session::SceneOptions{}, over_a_place}) {
        TitledWindow window;
        Opening opening(terrain, view);
        opening.begin(session::RayUse::none, 4096);
        const auto opened = opening.finish(window, silent, std::stop_source());
        ASSERT_TRUE(opened && opened->has_value());
        const auto& shown = *(*opened)->scene.terrain->get<scene::TerrainNode>()->surface;
        EXPECT_EQ((*opened)->finer != nullptr, !view.geodetic);
        EXPECT_EQ(shown.has_all_samples(), view.geodetic.has_value());
        EXPECT_EQ(
            ((*opened)->finer ? *(*opened)->finer : shown.terrain()).heightfield.heights.cols(),
            side);
    }
}

// As Esc does: Ctrl-C before there is a picture is no error.
TEST(Opening, IsEmptyIfItIsStopped) {
    TitledWindow window;
    session::SourceOptions terrain;
    terrain.terrain = "natural";
    Opening opening(terrain, session::SceneOptions{});
    std::stop_source stop;
    stop.request_stop();
    session::Log silent;
    opening.begin(session::RayUse::none, 4096);
    const auto opened = opening.finish(window, silent, stop);
    ASSERT_TRUE(opened) << opened.error().message;
    EXPECT_FALSE(*opened);
}

// Closes itself with Esc after some frames.
class FailingWindow final : public TitledWindow {
public:
    explicit FailingWindow(glm::ivec2 size) : size_(size) {}
    std::vector<Event> wait_events(std::chrono::milliseconds /*timeout*/) override {
        return frames < 3 ? std::vector<Event>{}
                          : std::vector<Event>{KeyEvent{.key = Key::escape, .pressed = true}};
    }
    [[nodiscard]] glm::ivec2 framebuffer_size() const override { return size_; }
    void swap_buffers() override { ++frames; }

    int frames = 0;

private:
    glm::ivec2 size_;
};

TEST(ShowFailure, TheSentenceStaysUntilTheUserClosesTheWindow) {
    Panels panels(Interface::create({.draws = false}).value());
    FailingWindow window({800, 600});
    show_failure(window, panels, "alps.tif: no heights found", {});
    EXPECT_EQ(window.frames, 3);
    EXPECT_TRUE(panels.is_over_panel({400.0, 5.0})) << "it covers the window";
    EXPECT_EQ(window.titles, std::vector<std::string>{"reljef - alps.tif: no heights found"});
}

TEST(ShowFailure, AStoppedOrTinyWindowEndsAtOnce) {
    Panels panels(Interface::create({.draws = false}).value());
    FailingWindow tiny({1, 1});
    show_failure(tiny, panels, "alps.tif: no heights found", {});
    EXPECT_EQ(tiny.frames, 0);
    std::stop_source stop;
    stop.request_stop();
    FailingWindow stopped({800, 600});
    show_failure(stopped, panels, "alps.tif: no heights found", stop.get_token());
    EXPECT_EQ(stopped.frames, 0);
}

TEST(Opening, EndsInTheMiddleOfReading) {
    session::SourceOptions terrain;
    terrain.terrain = "urban";
    const Opening opening(terrain, session::SceneOptions{});
}

} // namespace
} // namespace reljef::app
