#include "app/viewer/comparing/comparison.h"

#include <chrono>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/viewer/comparing/figure_rows.h"
#include "engine/truth/draw.h"
#include "tests/app/made_hill.h"

namespace reljef::app {
namespace {

using testing::HasSubstr;

constexpr glm::ivec2 window{200, 100};

struct ComparisonTest : testing::Test {
    session::TerrainScene scene = hill_scene();
    Comparison comparison{scene, {.threads = 1}};

    ComparedView exact_view() {
        const auto exact = truth::draw(scene.scene, {40, 30}).value();
        return {scene.scene.camera(), {{exact.image, exact.hits}}};
    }
    void wait() {
        do {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            comparison.update();
        } while (comparison.is_busy());
    }
    bool press(double x, bool pressed) {
        return comparison.receive(MouseButtonEvent{MouseButton::left, pressed, {x, 50.0}, {}},
                                  window);
    }
};

TEST_F(ComparisonTest, BeginsWithTheTruthAndComesBackToWhatWasComparedLast) {
    EXPECT_FALSE(comparison.is_on());
    ASSERT_TRUE(comparison.toggle());
    EXPECT_EQ(comparison.with(), CompareWith::truth);
    EXPECT_TRUE(comparison.take_redraw());
    EXPECT_FALSE(comparison.take_redraw());
    ASSERT_TRUE(comparison.next());
    EXPECT_EQ(comparison.with(), CompareWith::errors);
    ASSERT_TRUE(comparison.toggle());
    EXPECT_FALSE(comparison.is_on());
    ASSERT_TRUE(comparison.toggle());
    EXPECT_EQ(comparison.with(), CompareWith::errors);
    ASSERT_TRUE(comparison.next());
    EXPECT_EQ(comparison.with(), CompareWith::technique);
    ASSERT_TRUE(comparison.next());
    EXPECT_EQ(comparison.with(), CompareWith::truth);
}

TEST_F(ComparisonTest, FindsTheTruthAndTheErrorsOfAViewInTheBackground) {
    ASSERT_TRUE(comparison.set(CompareWith::truth));
    EXPECT_TRUE(comparison.awaits_view());
    EXPECT_THAT(comparison.content({}).state, HasSubstr("when the view rests"));
    EXPECT_EQ(comparison.right(), nullptr);
    comparison.find_errors(exact_view());
    EXPECT_FALSE(comparison.awaits_view());
    wait();
    ASSERT_NE(comparison.right(), nullptr);
    EXPECT_EQ(comparison.right()->cols(), 40);
    const CompareContent content = comparison.content({});
    EXPECT_EQ(content.state, "");
    ASSERT_FALSE(content.figures.empty());
    EXPECT_EQ(content.figures.front().left, "0 %");
    EXPECT_EQ(content.figures.front().right, "");
    EXPECT_TRUE(content.right_ms);
    ASSERT_TRUE(comparison.set(CompareWith::errors));
}

TEST_F(ComparisonTest, AChangedViewHasNoTruth) {
    ASSERT_TRUE(comparison.set(CompareWith::errors));
    comparison.find_errors(exact_view());
    wait();
    ASSERT_NE(comparison.right(), nullptr);
    comparison.forget_view();
    EXPECT_EQ(comparison.right(), nullptr);
    EXPECT_TRUE(comparison.awaits_view());
    EXPECT_TRUE(comparison.content({}).figures.empty());
}

TEST_F(ComparisonTest, StoppingWaitsForNothing) {
    ASSERT_TRUE(comparison.set(CompareWith::truth));
    for (int i = 0; i < 20; ++i) {
        comparison.find_errors(exact_view());
    }
    wait();
    EXPECT_NE(comparison.right(), nullptr);
}

TEST_F(ComparisonTest, TheLineFollowsTheMouseThatHoldsIt) {
    EXPECT_FALSE(press(100.0, true)); // nothing is compared
    press(100.0, false);
    ASSERT_TRUE(comparison.set(CompareWith::truth));
    EXPECT_FALSE(press(130.0, true)); // beside the line
    EXPECT_FALSE(comparison.receive(MouseMoveEvent{{150.0, 50.0}}, window));
    EXPECT_FALSE(press(130.0, false));
    EXPECT_TRUE(press(103.0, true));
    EXPECT_TRUE(comparison.receive(MouseMoveEvent{{50.0, 50.0}}, window));
    EXPECT_EQ(comparison.share(), 0.25);
    EXPECT_TRUE(comparison.receive(MouseMoveEvent{{-40.0, 50.0}}, window));
    EXPECT_EQ(comparison.share(), 0.0);
    EXPECT_TRUE(press(-40.0, false));
    EXPECT_FALSE(comparison.receive(MouseMoveEvent{{60.0, 50.0}}, window));
    comparison.set_share(std::nan(""));
    EXPECT_EQ(comparison.share(), 0.0);
    comparison.move_line(3);
    EXPECT_NEAR(comparison.share(), 0.15, 1e-12);
}

TEST_F(ComparisonTest, AnotherTechniqueIsDrawnWhenItsMapsAreReady) {
    ASSERT_TRUE(comparison.choose(scene::make_technique(scene::TechniqueId::cone)));
    EXPECT_EQ(comparison.with(), CompareWith::technique);
    wait();
    EXPECT_TRUE(comparison.draws_technique());
    EXPECT_NE(scene.terrain->get<scene::TerrainNode>()->cones, nullptr);
    EXPECT_NE(comparison.take_light(), nullptr);
    EXPECT_NE(scene.materials().front()->technique.id(), scene::TechniqueId::cone);
    const auto first = comparison.technique().id();
    comparison.choose_next();
    EXPECT_NE(comparison.technique().id(), first);
    const auto refused = comparison.choose(scene::make_technique(scene::TechniqueId::bump));
    EXPECT_FALSE(refused);
    wait();
}

TEST(FigureRows, SayWhatIsTooSmallToShow) {
    session::ErrorFigures figures;
    figures.wrong_percent = 0.001;
    figures.pixels = session::PixelQuantiles{0.001, 0.5, 1.0, 12.0};
    const auto rows = figure_rows(std::vector{figures, figures});
    EXPECT_EQ(rows.at(0).left, "< 0.01 %");
    EXPECT_EQ(rows.at(2).left, "< 0.01 px");
    EXPECT_EQ(rows.at(5).right, "12 px");
    EXPECT_LT(error_colors().front().height, error_colors().back().height);
}

} // namespace
} // namespace reljef::app
