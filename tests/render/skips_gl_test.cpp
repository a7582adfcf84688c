#include <algorithm>
#include <cstdlib>
#include <functional>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "tests/render/driver_fixture.h"

namespace reljef::render {
namespace {

constexpr glm::ivec2 seen{160, 120};

class SkipsGlTest : public DriverGlTest {
protected:
    using Change = std::function<void(session::SceneRendererOptions&)>;

    static session::SceneRenderer renderer_without(const Change& change) {
        session::SceneRendererOptions options;
        options.opengl.emplace();
        options.opengl->size = seen;
        change(options);
        return test::must(session::SceneRenderer::create(options));
    }
    // Drawn twice: what the first frame keeps is used.
    static Image drawn(const World& world, const Change& change) {
        session::SceneRenderer made = renderer_without(change);
        test::must(made.draw(world.scene));
        test::must(made.draw(world.scene));
        return made.read_color();
    }
    static view::PictureWork work(const World& world, const Change& change = nothing) {
        session::SceneRenderer made = renderer_without(change);
        return test::must(made.count_work(world.scene));
    }
    static std::vector<view::PixelWork> pixels_of(const World& world) {
        const view::PictureWork counted = work(world);
        const auto pixels = counted.pixels.samples();
        return {pixels.begin(), pixels.end()};
    }
    static void use(World& world, std::string_view technique) {
        world.terrain->get<scene::TerrainNode>()->material.technique =
            test::must(scene::parse_technique(technique));
    }
    static void nothing(session::SceneRendererOptions& /*options*/) {}
};

TEST_F(SkipsGlTest, ThePictureIsTheSameWithoutEachKind) {
    const std::vector<Change> changes{
        [](auto& options) { options.select.frustum = false; },
        [](auto& options) { options.select.front_to_back = false; },
        [](auto& options) { options.selects_always = true; },
        [](auto& options) { options.opengl->skips.blocks = false; },
        [](auto& options) { options.opengl->skips.uploads = false; },
        [](auto& options) { options.opengl->skips.cuts = false; },
        [](auto& options) { options.opengl->skips.certain = false; },
    };
    World world(3.0);
    for (const char* technique : {"polygons:error=1", "exact:shadow=hard"}) {
        use(world, technique);
        for (const auto which : {scene::Pose::low}) {
            world.look(pose(which, *world.terrain));
            const Image all = drawn(world, nothing);
            for (std::size_t i = 0; i < changes.size(); ++i) {
                EXPECT_EQ(drawn(world, changes[i]), all) << technique << ", change " << i;
            }
        }
    }
}

// Two nodes of one surface, turned against each other, have the sun from two sides.
TEST_F(SkipsGlTest, CertainLightIsThatOfEachNode) {
    World world(3.0);
    use(world, "exact:shadow=hard");
    const scene::TerrainNode first = *world.terrain->get<scene::TerrainNode>();
    const glm::dvec3 beside(1.5 * first.surface->bounds().size().x, 0.0, 0.0);
    world.scene.root()
        .add("turned", first)
        .set_parent_from_local(
            glm::rotate(glm::translate(glm::dmat4(1.0), beside), 2.0, {0.0, 0.0, 1.0}));
    world.look(pose(scene::Pose::overview, *world.terrain));
    const Image all = drawn(world, nothing);
    EXPECT_EQ(drawn(world, [](auto& options) { options.opengl->skips.certain = false; }), all);
}

// Drivers approximate exp(0).
TEST_F(SkipsGlTest, AirThatIsNotThereMovesColoursByOneLevelAtMost) {
    World world(3.0);
    use(world, "exact:shadow=hard");
    world.look(pose(scene::Pose::low, *world.terrain));
    const Image all = drawn(world, nothing);
    const Image other = drawn(world, [](auto& options) { options.opengl->skips.features = false; });
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Rgba8 a = all.samples()[i];
        const Rgba8 b = other.samples()[i];
        ASSERT_LE(std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)}), 1);
    }
}

TEST_F(SkipsGlTest, WithoutTheFrustumAllTilesAreDrawn) {
    World world;
    use(world, "polygons:lods=1");
    world.look(pose(scene::Pose::low, *world.terrain));
    auto all = renderer_without(nothing);
    auto without = renderer_without([](auto& options) { options.select.frustum = false; });
    const auto stats = test::must(without.draw(world.scene));
    EXPECT_LT(test::must(all.draw(world.scene)).triangles, stats.triangles);
    EXPECT_EQ(stats.triangles, 2U * 300U * 300U);
    EXPECT_EQ(stats.skipped.tiles_outside_frustum, 0);
}

TEST_F(SkipsGlTest, WhatIsNotKeptIsUploadedAgain) {
    World world;
    use(world, "polygons:error=1");
    world.look(pose(scene::Pose::low, *world.terrain));
    for (const bool keeps : {true, false}) {
        auto made = renderer_without([&](auto& options) { options.opengl->skips.uploads = keeps; });
        const std::size_t first = test::must(made.draw(world.scene)).upload_bytes;
        const std::size_t second = test::must(made.draw(world.scene)).upload_bytes;
        EXPECT_EQ(second < first / 10, keeps);
    }
    auto made = renderer_without([](auto& options) { options.opengl->skips.cuts = false; });
    const int first = test::must(made.draw(world.scene)).tiles_cut;
    EXPECT_GT(first, 0);
    EXPECT_EQ(test::must(made.draw(world.scene)).tiles_cut, first);
}

TEST_F(SkipsGlTest, ATerrainFromAboveTakesOneTapAPixel) {
    World world;
    use(world, "texture");
    world.look(camera_at({0.0, 0.0, 90.0}, {0.0, 1.0, 0.0}));
    const view::PictureWork counted = work(world);
    for (const view::PixelWork& pixel : counted.pixels.samples()) {
        EXPECT_EQ(pixel, (view::PixelWork{.taps = 1}));
    }
    EXPECT_EQ(view::totals_of(counted).taps, counted.pixels.size());
}

TEST_F(SkipsGlTest, EachTechniqueCountsItsTapsStepsAndRays) {
    World world;
    world.look(camera_at({0.0, 0.0, 90.0}, {0.0, 1.0, 0.0}));
    use(world, "parallax"); // a height and a colour
    for (const view::PixelWork& pixel : pixels_of(world)) {
        EXPECT_EQ(pixel, (view::PixelWork{.taps = 2, .steps = 0, .rays = 1}));
    }
    use(world, "parallax-iterated:k=3");
    for (const view::PixelWork& pixel : pixels_of(world)) {
        EXPECT_EQ(pixel, (view::PixelWork{.taps = 5, .steps = 3, .rays = 1}));
    }
    use(world, "steep:n=8"); // the height at the start, one for each step, and the colour
    for (const view::PixelWork& pixel : pixels_of(world)) {
        EXPECT_EQ(pixel.taps, pixel.steps + 2U);
        EXPECT_LE(pixel.steps, 8U);
        EXPECT_GE(pixel.steps, 1U);
    }
}

TEST_F(SkipsGlTest, SkippingTakesFewerTaps) {
    World world(3.0);
    use(world, "exact:shadow=hard");
    world.look(pose(scene::Pose::low, *world.terrain));
    const view::PictureWork counted = work(world);
    const std::size_t all = view::totals_of(counted).taps;
    EXPECT_GT(counted.beam_taps, 0U);
    for (const Change& change :
         {Change([](auto& options) { options.opengl->skips.beams = false; }),
          Change([](auto& options) { options.opengl->skips.blocks = false; }),
          Change([](auto& options) { options.opengl->skips.certain = false; })}) {
        EXPECT_GT(view::totals_of(work(world, change)).taps, all);
    }
}

} // namespace
} // namespace reljef::render
