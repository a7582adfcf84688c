#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/cast/frame/driver.h"
#include "engine/scene/motion/poses.h"
#include "tests/cast/made_rays.h"

namespace reljef::cast {
namespace {

constexpr glm::ivec2 seen{96, 64};

struct SkipStage : Stage {
    explicit SkipStage(Grid<float> heights, bool casts_shadows = false)
        : Stage(std::move(heights), {1.0, 1.0}) {
        light = &scene.add_light();
        scene.set_sky({.visibility = 900.0, .plane = {}});
        terrain->get<scene::TerrainNode>()->material.technique =
            test::must(scene::parse_technique(casts_shadows ? "exact:shadow=hard" : "exact"));
    }
    scene::Node* light = nullptr;

    void look_from(scene::Pose pose) {
        look(scene::pose_camera(pose, surface().bounds(), [&](double x, double y) {
            return surface().height_at(x, y).value_or(0.0);
        }));
    }
    [[nodiscard]] Image drawn(const DriverOptions& options) const {
        Driver driver = test::must(Driver::create(options));
        test::must(driver.draw(view::select(scene, seen)));
        test::must(driver.draw(view::select(scene, seen))); // what was kept is used
        return driver.read_color();
    }
    [[nodiscard]] view::PictureWork work(const RaySkips& skips = {}) const {
        Driver driver = test::must(Driver::create({.size = seen, .skips = skips}));
        return test::must(driver.count_work(view::select(scene, seen)));
    }
};

std::vector<RaySkips> each_left_out() {
    return {{.free_space = false},
            {.beams = false},
            {.blocks = false},
            {.cells = false},
            {.certain = false}};
}

constexpr RaySkips nothing_skipped{
    .free_space = false, .beams = false, .blocks = false, .cells = false, .certain = false};

TEST(RaySkips, ThePictureIsTheSameWithoutEach) {
    for (const bool casts_shadows : {false, true}) {
        SkipStage stage(test::hills(129, 97, 12.0), casts_shadows);
        for (const auto pose : {scene::Pose::overview, scene::Pose::low, scene::Pose::grazing}) {
            stage.look_from(pose);
            const Image all = stage.drawn({.size = seen});
            for (const RaySkips& skips : each_left_out()) {
                EXPECT_EQ(stage.drawn({.size = seen, .skips = skips}), all);
            }
            EXPECT_EQ(stage.drawn({.size = seen, .keeps_content = false}), all);
        }
    }
}

TEST(RaySkips, ContentThatIsNotKeptIsMadeAgain) {
    SkipStage stage(test::hills(65, 65, 3.0));
    stage.look_from(scene::Pose::low);
    for (const bool keeps : {true, false}) {
        Driver driver = test::must(Driver::create({.size = seen, .keeps_content = keeps}));
        test::must(driver.draw(view::select(stage.scene, seen)));
        const auto again = test::must(driver.draw(view::select(stage.scene, seen)));
        EXPECT_EQ(again.uploads == 0, keeps);
        EXPECT_EQ(again.upload_bytes == 0, keeps);
    }
}

// Slopes of tiles near the eye are remembered from frame to frame.
TEST(RaySkips, ALaterFrameStatesTheErrorOfAFirstOne) {
    SkipStage gentle(test::hills(129, 97, 4.0));
    SkipStage steep(test::hills(129, 97, 3000.0));
    Driver kept = test::must(Driver::create({.size = seen}));
    double largest = 0.0;
    for (const double east : {-20.0, 3.0, 21.0, 3.0}) {
        for (SkipStage* const stage : {&gentle, &steep}) {
            const double ground = stage->surface().height_at(east, 2.0).value_or(0.0);
            scene::Camera camera;
            camera.eye = {east, 2.0, ground + 0.3};
            camera.target = {east + 9.0, 20.0, ground};
            stage->look(camera);
            const auto frame = view::select(stage->scene, seen);
            Driver fresh = test::must(Driver::create({.size = seen}));
            const auto stated = test::must(fresh.draw(frame)).kept_error;
            ASSERT_TRUE(stated);
            EXPECT_EQ(test::must(kept.draw(frame)).kept_error, stated);
            largest = std::max(largest, *stated);
        }
    }
    EXPECT_GT(largest, 0.02); // smaller ones need no slopes of tiles
}

// Over flat ground a ray crosses L lines between the cells below the eye and the hit. Without any
// skipping it reads the maximum of each cell and solves it.
TEST(RayWork, IsThatOfTheCellsThatARayCrosses) {
    SkipStage stage(Grid<float>(129, 129, 5.0F));
    const glm::dvec3 eye(0.3, -0.4, 9.0);
    stage.look({.eye = eye, .target = {20.0, 31.0, 5.0}});
    Driver driver = test::must(Driver::create({.size = seen}));
    const HitBuffer hits = test::must(driver.draw_hits(view::select(stage.scene, seen))).hits;
    const view::PictureWork work = stage.work(nothing_skipped);
    const glm::dvec2 below(64.0 + eye.x, 64.0 - eye.y); // samples
    int checked = 0;
    for (int row = 0; row < seen.y; ++row) {
        for (int col = 0; col < seen.x; ++col) {
            const Hit& hit = hits(col, row);
            const glm::dvec2 place = hit.place();
            const bool is_on_line = std::abs(place.x - std::round(place.x)) < 1e-3 ||
                                    std::abs(place.y - std::round(place.y)) < 1e-3;
            if (hit.is_sky() || is_on_line) {
                continue;
            }
            const auto lines =
                static_cast<unsigned>(std::abs(std::floor(place.x) - std::floor(below.x)) +
                                      std::abs(std::floor(place.y) - std::floor(below.y)));
            const view::PixelWork& pixel = work.pixels(col, row);
            EXPECT_EQ(pixel.rays, 1U);
            EXPECT_EQ(pixel.steps, 2U * (1U + lines)) << col << ' ' << row;
            const unsigned texels = pixel.taps - 5U * (1U + lines);
            EXPECT_TRUE(texels == 4U || texels == 8U) << texels;
            ++checked;
        }
    }
    EXPECT_GT(checked, seen.x * seen.y / 4);
    EXPECT_EQ(work.beam_taps, 0U);
}

TEST(RayWork, IsLessWithEachKindOfSkipping) {
    SkipStage stage(test::hills(257, 257, 25.0));
    stage.look_from(scene::Pose::low);
    const view::WorkTotals all = view::totals_of(stage.work());
    EXPECT_GT(all.taps, 0U);
    for (const RaySkips& skips : each_left_out()) {
        if (skips.certain) { // it has no sun rays
            EXPECT_GT(view::totals_of(stage.work(skips)).taps, all.taps);
        }
    }
}

TEST(RayWork, ASunRayIsARayAndOneFromACertainCellIsNone) {
    SkipStage stage(test::hills(129, 129, 12.0), true);
    stage.light->get<scene::Light>()->altitude = 6.0; // slopes are steeper: some face away
    stage.look_from(scene::Pose::overview);
    const view::WorkTotals some = view::totals_of(stage.work());
    const view::WorkTotals more = view::totals_of(stage.work({.certain = false}));
    EXPECT_LT(some.rays, more.rays);
    EXPECT_LT(some.steps, more.steps);
}

} // namespace
} // namespace reljef::cast
