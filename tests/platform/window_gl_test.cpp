#include "engine/platform/window.h"

#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>

#include <fmt/format.h>
#include <glad/gl.h>
#include <gmock/gmock.h>

#include "engine/gl/framebuffer.h"
#include "tests/gl/gl_fixture.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace reljef::platform {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

class WindowGlTest : public ::testing::Test {
protected:
    void SetUp() override {
        if (std::getenv("DISPLAY") == nullptr) {
            GTEST_SKIP() << "no display: DISPLAY is not set";
        }
        auto made = make_window({.debug = true, .size = {320, 200}, .title = "test"});
        ASSERT_TRUE(made) << made.error().message;
        window_ = std::move(*made);
        log_.emplace();
    }
    void TearDown() override {
        if (log_) {
            EXPECT_THAT(log_->problems(), ::testing::IsEmpty());
        }
        log_.reset();
        window_.reset();
    }

    Window& window() { return *window_; }

    /// Waits for an event of that kind, up to a minute.
    template <class Kind> std::optional<Kind> next() {
        const auto start = steady_clock::now();
        while (steady_clock::now() - start < std::chrono::minutes(1)) {
            for (const Event& event : window_->wait_events(milliseconds(50))) {
                if (const auto* found = std::get_if<Kind>(&event)) {
                    return *found;
                }
            }
        }
        return std::nullopt;
    }

private:
    std::unique_ptr<Window> window_;
    std::optional<test::DebugLog> log_;
};

TEST_F(WindowGlTest, has_the_asked_size_and_a_current_context) {
    EXPECT_EQ(window().framebuffer_size(), glm::ivec2(320, 200));
    EXPECT_EQ(window().context().kind(), ContextKind::glfw);
    EXPECT_TRUE(window().context().is_current());
    EXPECT_FALSE(window().should_close());
}

TEST_F(WindowGlTest, closing_is_seen) {
    glfwSetWindowShouldClose(glfwGetCurrentContext(), GLFW_TRUE);
    EXPECT_TRUE(window().should_close());
}

TEST_F(WindowGlTest, resizing_is_told) {
    glfwSetWindowSize(glfwGetCurrentContext(), 400, 300);
    const auto resize = next<ResizeEvent>();
    ASSERT_TRUE(resize);
    EXPECT_EQ(resize->framebuffer, glm::ivec2(400, 300));
    EXPECT_EQ(window().framebuffer_size(), glm::ivec2(400, 300));
}

// GLFW tells no move of its own, and a mouse that is at that place already does not move: another
// program moves it, there and back.
TEST_F(WindowGlTest, moving_the_mouse_is_told_in_pixels) {
    if (!std::filesystem::exists("/usr/bin/xdotool")) {
        GTEST_SKIP() << "no xdotool";
    }
    const std::string to_window = fmt::format(
        "xdotool search --sync --onlyvisible --pid {} --name '^test$' mousemove --window %1 ",
        getpid());
    const glm::dvec2 place(37.0, 41.0);
    const auto start = steady_clock::now();
    bool is_told = false;
    while (!is_told && steady_clock::now() - start < std::chrono::minutes(1)) {
        ASSERT_EQ(std::system((to_window + "90 60 mousemove --window %1 37 41").c_str()), 0);
        for (const Event& event : window().wait_events(milliseconds(50))) {
            const auto* const move = std::get_if<MouseMoveEvent>(&event);
            is_told = is_told || (move != nullptr && move->position == place);
        }
    }
    EXPECT_TRUE(is_told);
}

TEST_F(WindowGlTest, a_press_is_where_the_pointer_was_then) {
    if (!std::filesystem::exists("/usr/bin/xdotool")) {
        GTEST_SKIP() << "no xdotool";
    }
    while (!window().wait_events(milliseconds(0)).empty()) {
    }
    const std::string command = fmt::format(
        "xdotool search --sync --onlyvisible --pid {} --name '^test$' mousemove --window %1 20 30 "
        "mousedown 1 mousemove --window %1 60 40 mouseup 1",
        getpid());
    ASSERT_EQ(std::system(command.c_str()), 0); // NOLINT(cert-env33-c): a fixed program
    std::vector<glm::dvec2> places;
    for (int round = 0; round < 50 && places.size() < 2; ++round) {
        for (const Event& event : window().wait_events(milliseconds(100))) {
            if (const auto* const button = std::get_if<MouseButtonEvent>(&event)) {
                places.push_back(button->position);
            }
        }
    }
    EXPECT_THAT(places, testing::ElementsAre(glm::dvec2(20.0, 30.0), glm::dvec2(60.0, 40.0)));
}

TEST_F(WindowGlTest, polling_and_waiting_end_where_nothing_happens) {
    // What the window's opening still brings comes first.
    while (!window().wait_events(milliseconds(0)).empty()) {
    }
    EXPECT_THAT(window().wait_events(milliseconds(0)), ::testing::IsEmpty());
    while (!window().wait_events(milliseconds(20)).empty()) {
    }
}

TEST_F(WindowGlTest, a_framebuffer_fills_it_once_it_is_larger) {
    const auto framebuffer = gl::Framebuffer::create({.size = {400, 300}});
    ASSERT_TRUE(framebuffer) << framebuffer.error().message;
    framebuffer->clear_color(glm::vec4(1.0F));
    framebuffer->blit_to_window(window().framebuffer_size());
    window().swap_buffers();
    glfwSetWindowSize(glfwGetCurrentContext(), 400, 300);
    ASSERT_TRUE(next<ResizeEvent>());
    framebuffer->bind();
    framebuffer->blit_to_window(window().framebuffer_size());
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    std::array<unsigned char, 4> pixel{};
    glReadPixels(395, 295, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel.data());
    EXPECT_EQ(pixel[0], 255);
    window().swap_buffers();
}

TEST_F(WindowGlTest, a_framebuffer_blitted_to_it_keeps_its_bytes) {
    glfwSwapInterval(0);
    window().set_title("blit");
    window().capture_mouse(true);
    window().capture_mouse(false);
    const auto framebuffer = gl::Framebuffer::create({.size = {320, 200}});
    ASSERT_TRUE(framebuffer) << framebuffer.error().message;
    framebuffer->clear_color(glm::vec4(0.5F, 0.0F, 1.0F, 1.0F));
    framebuffer->blit_to_window(window().framebuffer_size());
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    std::array<unsigned char, 4> pixel{};
    glReadPixels(100, 100, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel.data());
    EXPECT_NEAR(pixel[0], 188, 1);
    EXPECT_EQ(pixel[1], 0);
    EXPECT_EQ(pixel[2], 255);
    window().swap_buffers();
}

Rgba8 shown_at(int x, int y) {
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    Rgba8 pixel{};
    glReadPixels(x, y, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, &pixel);
    return pixel;
}

TEST_F(WindowGlTest, a_picture_of_the_cpu_is_upright_and_keeps_its_colours) {
    for (const gl::Format format : {gl::Format::rgba8_srgb, gl::Format::window8}) {
        auto framebuffer =
            gl::Framebuffer::create({.size = {320, 200}, .color = format, .depth = false});
        ASSERT_TRUE(framebuffer) << framebuffer.error().message;
        Image picture(320, 200);
        std::fill(picture.row(0).begin(), picture.row(0).end(), Rgba8{255, 20, 60, 255});
        framebuffer->upload(picture);
        framebuffer->blit_to_window({320, 200}, gl::FirstRow::top);
        EXPECT_EQ(shown_at(10, 199), (Rgba8{255, 20, 60, 255}));
        EXPECT_EQ(shown_at(10, 0), Rgba8{});
        window().swap_buffers();
    }
}

TEST_F(WindowGlTest, an_area_is_uploaded_and_shown_where_it_was_drawn) {
    auto kept =
        gl::Framebuffer::create({.size = {320, 200}, .color = gl::Format::window8, .depth = false});
    ASSERT_TRUE(kept) << kept.error().message;
    kept->clear_color({0.0F, 0.0F, 0.0F, 1.0F});
    const Image drawn(320, 200, {255, 0, 0, 255});
    kept->upload_area({100, 20}, drawn.view().window(100, 20, 50, 30)); // rows from the top
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glClearColor(0.0F, 0.0F, 1.0F, 1.0F);
    glClear(GL_COLOR_BUFFER_BIT);
    kept->blit_area_to_window({90, 10}, {50, 30});
    constexpr Rgba8 red{255, 0, 0, 255};
    constexpr Rgba8 blue{0, 0, 255, 255};
    EXPECT_EQ(shown_at(100, 199 - 20), red);
    EXPECT_EQ(shown_at(139, 199 - 39), red);
    EXPECT_EQ(shown_at(95, 199 - 15), Rgba8{}); // kept, but not drawn
    EXPECT_EQ(shown_at(140, 199 - 30), blue);   // not shown
    EXPECT_EQ(shown_at(120, 199 - 40), blue);
    window().swap_buffers();
}

} // namespace
} // namespace reljef::platform
