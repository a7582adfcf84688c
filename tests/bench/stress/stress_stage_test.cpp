#include "bench/stress/stress_stage.h"

#include <limits>

#include <gtest/gtest.h>

#include "bench/stress/made_surfaces.h"
#include "tests/render/made_scene.h"

namespace reljef::bench {
namespace {

constexpr glm::ivec2 small_size{32, 24};

// The lower half of the picture is ground, the upper half sky.
struct HalfView {
    StressStage stage = StressStage::create(made_hills(glm::ivec2(65), 2.0, 0.0)).value();
    HitBuffer truth;

    HalfView() {
        stage.look(test::camera_at({0.0, -30.0, 4.0}, {0.0, 0.0, 4.0}));
        truth = stage.true_hits(small_size, {}).value();
    }
};

TEST(StressStage, SkyInTheMiddleOfGroundIsCounted) {
    HalfView view;
    HitBuffer shown = view.truth;
    EXPECT_EQ(count_sky_over_ground(view.stage, shown, view.truth, {}), 0U);
    shown(16, 20) = {};
    shown(17, 20) = {};
    EXPECT_EQ(count_sky_over_ground(view.stage, shown, view.truth, {}), 2U);
}

TEST(StressStage, ASilhouetteWithinReachIsNoHole) {
    HalfView view;
    int horizon = 0;
    while (!truth::shows_terrain(view.truth(16, horizon))) {
        ++horizon;
    }
    HitBuffer shown = view.truth;
    shown(16, horizon) = {};
    EXPECT_EQ(count_sky_over_ground(view.stage, shown, view.truth, {}), 0U);
    shown(16, horizon + 3) = {};
    EXPECT_EQ(count_sky_over_ground(view.stage, shown, view.truth, {}), 1U);
}

TEST(StressStage, AHitThatIsNoNumberIsCounted) {
    HalfView view;
    EXPECT_EQ(count_not_finite(view.truth), 0U);
    view.truth(16, 20).height = std::numeric_limits<float>::quiet_NaN();
    view.truth(3, 20).col = std::numeric_limits<float>::infinity();
    EXPECT_EQ(count_not_finite(view.truth), 2U);
}

} // namespace
} // namespace reljef::bench
