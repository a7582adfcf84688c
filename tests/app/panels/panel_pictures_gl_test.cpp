#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glad/gl.h>
#include <gtest/gtest.h>

#include "app/viewer/panels/panels.h"
#include "app/viewer/panels/toolkit/panel_layout.h"
#include "engine/core/color.h"
#include "engine/gl/framebuffer.h"
#include "engine/platform/window.h"
#include "tests/support/release_only.h"

namespace reljef::app {
namespace {

constexpr glm::ivec2 shown_size{1024, 768};
constexpr double seconds_a_frame = 1.0 / 60.0;
// Where texels meet at the centres of its pixels, either may be shown.
constexpr std::size_t pixels_of_a_letter = 50;
constexpr Rgba8 background{64, 128, 191, 255};

// Panels over a plain picture in a hidden window: drawn by the CPU where they change and kept, and
// drawn wholly by OpenGL in each frame.
class PanelPicturesGlTest : public testing::Test {
protected:
    void SetUp() override {
        if (std::getenv("DISPLAY") == nullptr) {
            GTEST_SKIP() << "no display: DISPLAY is not set";
        }
        auto made = platform::make_window({.size = shown_size, .visible = false});
        ASSERT_TRUE(made) << made.error().message;
        window_ = std::move(*made);
        other_ = gl::Framebuffer::create({.size = {64, 64}}).value();
        make_panels(1.0);
        content_.terrain = "hills";
        content_.technique.requested = scene::Technique{scene::Relief{}};
        for (const scene::TechniqueInfo& info : scene::technique_catalogue()) {
            content_.technique.choices.push_back({scene::make_technique(info.id), {}, {}});
        }
        content_.legend = {{0.0, {0, 0, 0, 255}}, {1000.0, {255, 255, 255, 255}}};
        content_.metres_per_pixel = 10.0;
        content_.keys = {{"H", "help"}};
    }

    void make_panels(double scale) {
        panels_ = std::make_unique<Panels>(Interface::create({.scale = scale}).value());
        redrawn_ = std::make_unique<Panels>(
            Interface::create({.scale = scale, .keeps_unchanged = false}).value());
    }

    // The window's back buffer with a frame of the panels. Another framebuffer is bound before.
    std::vector<Rgba8> picture_of(Panels& panels) {
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        glDisable(GL_SCISSOR_TEST);
        glClearColor(0.25F, 0.5F, 0.75F, 1.0F);
        glClear(GL_COLOR_BUFFER_BIT);
        other_.bind();
        panels.draw(content_, size_, seconds_a_frame);
        return picture();
    }

    [[nodiscard]] std::vector<Rgba8> picture() const {
        std::vector<Rgba8> pixels(static_cast<std::size_t>(size_.x) *
                                  static_cast<std::size_t>(size_.y));
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        glReadPixels(0, 0, size_.x, size_.y, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
        return pixels;
    }

    [[nodiscard]] Rgba8 shown_at(std::size_t column, std::size_t row) const {
        const auto width = static_cast<std::size_t>(size_.x);
        return picture()[(static_cast<std::size_t>(size_.y) - 1 - row) * width + column];
    }

    void receive(const Event& event) {
        panels_->receive(event);
        redrawn_->receive(event);
    }

    // Frames of both until they rest.
    void expect_same_pictures(const std::string& what) {
        for (int frame = 0; frame < 4; ++frame) {
            const std::vector<Rgba8> of_changes = picture_of(*panels_);
            const std::vector<Rgba8> whole = picture_of(*redrawn_);
            ASSERT_LE(pixels_that_differ(of_changes, whole), pixels_of_a_letter)
                << what << ", frame " << frame << first_differences(of_changes, whole);
        }
    }

    [[nodiscard]] std::string first_differences(const std::vector<Rgba8>& a,
                                                const std::vector<Rgba8>& b) const {
        std::string text;
        int left = 10;
        for (std::size_t i = 0; i < a.size() && left > 0; ++i) {
            if (!is_near(a[i], b[i])) {
                const auto column = i % static_cast<std::size_t>(size_.x);
                const auto row = i / static_cast<std::size_t>(size_.x);
                text += fmt::format("; {},{}: {} {} {} and {} {} {}", column,
                                    static_cast<std::size_t>(size_.y) - 1 - row, a[i].r, a[i].g,
                                    a[i].b, b[i].r, b[i].g, b[i].b);
                --left;
            }
        }
        return text;
    }

    // By at most two steps of a channel: drivers round blended colours in several ways.
    static bool is_near(Rgba8 a, Rgba8 b) {
        return std::abs(a.r - b.r) <= 2 && std::abs(a.g - b.g) <= 2 && std::abs(a.b - b.b) <= 2;
    }

    static std::size_t pixels_that_differ(const std::vector<Rgba8>& a,
                                          const std::vector<Rgba8>& b) {
        std::size_t count = 0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            count += is_near(a[i], b[i]) ? 0U : 1U;
        }
        return count;
    }

    void change_figures(std::mt19937& random) {
        content_.frame.stats.rays = random() % 2000000U;
        content_.frame.recent_ms.push_back(static_cast<float>(random() % 40));
        content_.messages = {{fmt::format("note {}", random() % 100), false, 1.0}};
    }

    std::unique_ptr<platform::Window> window_;
    std::unique_ptr<Panels> panels_;
    std::unique_ptr<Panels> redrawn_; // wholly in each frame
    PanelContent content_;
    glm::ivec2 size_ = shown_size; // of the part of the window that is drawn
    gl::Framebuffer other_;
};

TEST_F(PanelPicturesGlTest, WhatChangedAloneIsDrawnAndLooksAsIfAllWere) {
    std::mt19937 random(20);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    const PanelLayout layout = layout_for(shown_size, 1.0);
    const glm::dvec2 room = layout.inspector.size();
    for (int step = 0; step < test::cases(30, 80); ++step) {
        const glm::dvec2 part(share(random), share(random));
        const glm::dvec2 at = layout.inspector.low + part * room;
        receive(MouseMoveEvent{at});
        if (step % 3 == 0) {
            receive(MouseButtonEvent{MouseButton::left, true, at, {}});
            receive(MouseButtonEvent{MouseButton::left, false, at, {}}); // in the second frame
        }
        if (step % 2 == 0) {
            change_figures(random);
        }
        expect_same_pictures(fmt::format("step {}", step));
    }
}

TEST_F(PanelPicturesGlTest, MarksUnderPanelsAreOverThePictureOfTheWindow) {
    expect_same_pictures("no point yet");
    EXPECT_EQ(shown_at(300, 300), background);
    content_.measure.is_on = true;
    content_.measure.points = {{"a", "ground", glm::dvec2(300.0, 300.0)},
                               {"b", "ground", glm::dvec2(500.0, 420.0)}};
    expect_same_pictures("two points");
    EXPECT_NE(shown_at(300, 300), background) << "without a panel there";
    content_.measure.points.pop_back();
    expect_same_pictures("one point");
    content_.measure = {};
    expect_same_pictures("no point");
}

TEST_F(PanelPicturesGlTest, PanelsOfAWindowOfAnotherSizeAreDrawnAnew) {
    for (const glm::ivec2 size : {glm::ivec2(800, 700), glm::ivec2(1024, 600), shown_size}) {
        size_ = size;
        expect_same_pictures(fmt::format("{} x {}", size.x, size.y));
    }
}

TEST_F(PanelPicturesGlTest, PanelsOfScreensWithSmallPixelsLookTheSame) {
    for (const double scale : {1.25, 1.7}) {
        make_panels(scale);
        expect_same_pictures(fmt::format("scale {}", scale));
    }
}

TEST_F(PanelPicturesGlTest, KeptPanelsAreShownAsTheyWereDrawn) {
    do {
        picture_of(*panels_);
    } while (panels_->is_stale());
    const std::vector<Rgba8> drawn = picture();
    ASSERT_FALSE(panels_->is_due(shown_size, 0.0));
    glClear(GL_COLOR_BUFFER_BIT);
    panels_->show_again();
    EXPECT_EQ(pixels_that_differ(picture(), drawn), 0U);
    EXPECT_GT(pixels_that_differ(drawn, std::vector<Rgba8>(drawn.size(), drawn.front())), 10'000U);
}

} // namespace
} // namespace reljef::app
