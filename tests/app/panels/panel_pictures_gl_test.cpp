#include <cstdlib>
#include <memory>
#include <random>
#include <vector>

#include <fmt/format.h>
#include <glad/gl.h>
#include <gtest/gtest.h>

#include "app/viewer/panels/panels.h"
#include "app/viewer/panels/toolkit/panel_layout.h"
#include "engine/core/color.h"
#include "engine/platform/window.h"

namespace reljef::app {
namespace {

constexpr glm::ivec2 shown_size{1024, 768};
constexpr double seconds_a_frame = 1.0 / 60.0;

// Panels over a plain picture in a hidden window.
class PanelPicturesGlTest : public testing::Test {
protected:
    void SetUp() override {
        if (std::getenv("DISPLAY") == nullptr) {
            GTEST_SKIP() << "no display: DISPLAY is not set";
        }
        auto made = platform::make_window({.size = shown_size, .visible = false});
        ASSERT_TRUE(made) << made.error().message;
        window_ = std::move(*made);
        panels_ = std::make_unique<Panels>(Interface::create({}).value());
        redrawn_ = std::make_unique<Panels>(Interface::create({.keeps_unchanged = false}).value());
        content_.terrain = "hills";
        content_.technique.requested = scene::Technique{scene::Relief{}};
        for (const scene::TechniqueInfo& info : scene::technique_catalogue()) {
            content_.technique.choices.push_back({scene::make_technique(info.id), {}, {}});
        }
        content_.legend = {{0.0, {0, 0, 0, 255}}, {1000.0, {255, 255, 255, 255}}};
        content_.metres_per_pixel = 10.0;
        content_.keys = {{"H", "help"}};
    }

    // The window's back buffer with a frame of the panels.
    std::vector<Rgba8> picture_of(Panels& panels) {
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        glDisable(GL_SCISSOR_TEST);
        glClearColor(0.25F, 0.5F, 0.75F, 1.0F);
        glClear(GL_COLOR_BUFFER_BIT);
        panels.draw(content_, shown_size, seconds_a_frame);
        return picture();
    }

    static std::vector<Rgba8> picture() {
        std::vector<Rgba8> pixels(std::size_t{1024} * std::size_t{768});
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        glReadPixels(0, 0, shown_size.x, shown_size.y, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
        return pixels;
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
};

std::size_t pixels_that_differ(const std::vector<Rgba8>& a, const std::vector<Rgba8>& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        count += a[i] == b[i] ? 0U : 1U;
    }
    return count;
}

TEST_F(PanelPicturesGlTest, WhatChangedAloneIsDrawnAndLooksAsIfAllWere) {
    std::mt19937 random(20);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    const PanelLayout layout = layout_for(shown_size, 1.0);
    const glm::dvec2 room = layout.inspector.size();
    const auto receive = [&](const Event& event) {
        panels_->receive(event);
        redrawn_->receive(event);
    };
    for (int step = 0; step < 80; ++step) {
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
        for (int frame = 0; frame < 3; ++frame) {
            const std::vector<Rgba8> of_changes = picture_of(*panels_);
            ASSERT_EQ(pixels_that_differ(of_changes, picture_of(*redrawn_)), 0U)
                << "step " << step << ", frame " << frame;
        }
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
