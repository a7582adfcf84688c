#include "engine/view/choice/typical_search.h"

#include <vector>

#include <gtest/gtest.h>

#include "tests/render/made_scene.h"
#include "tests/terrain/chance.h"

namespace reljef::view {
namespace {

// Searches over a terrain 300 samples wide, 2 m apart, seen from above its south.
struct SearchStage {
    scene::Scene scene;
    const scene::TerrainSurface* surface = nullptr;
    DrawList list;

    explicit SearchStage(Grid<float> heights) {
        scene::Node& node =
            test::add_terrain(scene, test::plane_heightfield(std::move(heights), {2, 2}));
        surface = &test::surface_of(node);
        list.camera = test::camera_at({0.0, -400.0, 150.0}, {0.0, 0.0, 0.0});
        list.size = {320, 240};
    }
    [[nodiscard]] TypicalSearch search() const { return {{list.camera, list.size}, *surface}; }
    [[nodiscard]] std::vector<ProbeRay> probes(int count) const {
        test::Chance chance(7);
        std::vector<ProbeRay> probes;
        while (static_cast<int>(probes.size()) < count) {
            const glm::dvec2 pixel(chance.between(0.0, list.size.x),
                                   chance.between(0.0, list.size.y));
            const Ray ray = scene::view_ray(list.camera, list.size, pixel);
            if (intersect(ray, surface->bounds())) {
                const auto hit = surface->pick(ray);
                probes.push_back({ray, pixel, hit ? std::optional(hit->sample) : std::nullopt});
            }
        }
        return probes;
    }
};

scene::Technique interval(int steps, int secants = 2) {
    return {scene::Interval{.linear_steps = steps, .secant_steps = secants}};
}

scene::Technique relief(int steps) {
    return {scene::Relief{.linear_steps = steps}};
}

Grid<float> slope(double metres_a_column) {
    return test::made_heights(300, 300,
                              [&](int col, int /*row*/) { return metres_a_column * col; });
}

// Heights rise in proportion along a ray over a slope, so that one secant step is exact.
TEST(TypicalSearchTest, FindsASlopeExactly) {
    const SearchStage stage(slope(0.3));
    const auto probes = stage.probes(2000);
    const auto trial = stage.search().try_along(interval(4), probes, {.bound = 1e-3, .share = 1.0});
    ASSERT_TRUE(trial.has_value());
    EXPECT_GT(trial->terrain_probes, 1000);
    EXPECT_EQ(trial->within, trial->terrain_probes);
}

TEST(TypicalSearchTest, CountsTheStepsOfMissedAndOfFoundRays) {
    const SearchStage stage(slope(0.3));
    const TypicalSearch search = stage.search();
    for (const ProbeRay& probe : stage.probes(500)) {
        const auto found = search.find(interval(8, 3), probe);
        EXPECT_EQ(found.place.has_value(), probe.hit.has_value());
        EXPECT_LE(found.steps, 8 + 2);
        EXPECT_GE(found.steps, found.place ? 1 + 2 : 8);
    }
}

// A shift by the height at the entry is exact where the height is the same at the hit.
TEST(TypicalSearchTest, ParallaxFindsALevelPlateau) {
    Grid<float> heights = slope(0.0);
    for (int row = 20; row < 280; ++row) {
        std::ranges::fill(heights.row(row), 10.0F);
    }
    const SearchStage stage(std::move(heights));
    const TypicalSearch search = stage.search();
    const auto parallax = scene::make_technique(scene::TechniqueId::parallax);
    int found = 0;
    for (const ProbeRay& probe : stage.probes(2000)) {
        const auto is_inside = [](double place) { return place > 60.0 && place < 240.0; };
        if (probe.hit && is_inside(probe.hit->x) && is_inside(probe.hit->y)) {
            const auto shown = search.find(parallax, probe);
            ASSERT_TRUE(shown.place.has_value());
            EXPECT_LT(glm::distance(*shown.place, glm::dvec2(*probe.hit)), 1e-3);
            EXPECT_EQ(shown.steps, 0);
            ++found;
        }
    }
    EXPECT_GT(found, 500);
}

// What stands behind a thin wall is at its true pixel, but hidden: it must not count as right.
TEST(TypicalSearchTest, AThinWallThatStepsSkipIsNotWithinTheBound) {
    Grid<float> heights = slope(0.0);
    for (int row = 0; row < heights.rows(); row += 20) {
        std::ranges::fill(heights.row(row), 30.0F);
    }
    const SearchStage stage(std::move(heights));
    const auto probes = stage.probes(2000);
    const TypicalSearch search = stage.search();
    double last = 0.0;
    for (const int steps : {4, 28, 400}) {
        const auto trial = search.try_along(relief(steps), probes, {.bound = 1.0, .share = 0.0});
        EXPECT_GT(trial->share(), last) << steps;
        last = trial->share();
    }
    EXPECT_FALSE(search.try_along(relief(4), probes, {.bound = 1.0, .share = 0.5}));
    EXPECT_GT(last, 0.9);
}

// A share of a few probes says little, and one of none nothing.
TEST(TypicalSearchTest, FewProbesProveNothing) {
    const SearchStage stage(slope(0.3));
    EXPECT_FALSE(stage.search().try_along(interval(4), {}, {}));
    std::vector<ProbeRay> probes = stage.probes(200);
    std::erase_if(probes, [](const ProbeRay& probe) { return !probe.hit; });
    probes.resize(29);
    EXPECT_FALSE(stage.search().try_along(interval(4), probes, {}));
    probes.push_back(probes.front());
    EXPECT_TRUE(stage.search().try_along(interval(4), probes, {}));
}

TEST(TypicalSearchTest, MovesWithTheTerrain) {
    const SearchStage stage(slope(0.3));
    const glm::dvec3 offset(1000.0, -3000.0, 50.0);
    scene::Camera camera = stage.list.camera;
    camera.eye += offset;
    camera.target += offset;
    const TypicalSearch moved({camera, stage.list.size, offset}, *stage.surface);
    const auto probes = stage.probes(300);
    const auto here = stage.search().try_along(interval(8), probes, {.bound = 0.5});
    const auto there = moved.try_along(interval(8), probes, {.bound = 0.5});
    ASSERT_TRUE(here && there);
    EXPECT_EQ(here->within, there->within);
}

} // namespace
} // namespace reljef::view
