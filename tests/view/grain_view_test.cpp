#include "engine/view/grain_view.h"

#include <memory>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "engine/scene/streaming/terrain_surface.h"
#include "engine/terrain/field/color_ramp.h"
#include "tests/render/made_scene.h"
#include "tests/terrain/chance.h"

namespace reljef::view {
namespace {

constexpr int cases = 1000;

struct Ground {
    scene::Scene scene;
    scene::Node* terrain = nullptr;
    DrawList list;

    explicit Ground(glm::dvec2 spacing, double exaggeration = 1.0) {
        terrain = &test::add_terrain(
            scene, test::plane_heightfield(test::hills(65, 33, 20.0), spacing), {},
            {.placement = terrain::PlacementKind::plane, .exaggeration = exaggeration});
    }
    GrainView from(glm::dvec3 eye) {
        list.camera.eye = eye;
        return grain_view(list, *terrain->get<scene::TerrainNode>(), terrain->world_from_local());
    }
};

TEST(GrainView, BeginsWhereTheDataEnd) {
    for (const double spacing : {0.02, 0.5, 1.0, 30.0, 90.0, 1e4}) {
        const GrainView view = Ground(glm::dvec2(spacing)).from({});
        // The longest waves are a fifth of a pattern, the shortest of the data two samples.
        const double longest = 0.2 / static_cast<double>(view.patterns[0].w);
        const double longest_ever = 300.0; // metres: longer ones are hills, which no one measured
        EXPECT_NEAR(longest, std::min(2.0 * spacing, longest_ever), 1e-6 * spacing);
        ASSERT_GE(view.pattern_count, 1);
        for (int i = 1; i < view.pattern_count; ++i) {
            const auto index = static_cast<std::size_t>(i);
            EXPECT_GT(view.patterns[index].w, 10.0F * view.patterns[index - 1].w);
        }
    }
}

// The widest pattern, ten samples, has faded where its 256 texels cover four pixels.
TEST(GrainView, IsSeenUntilTheWidestPatternHasFaded) {
    for (const double spacing : {1.0, 30.0}) {
        Ground ground{glm::dvec2(spacing)};
        scene::TerrainNode& terrain = *ground.terrain->get<scene::TerrainNode>();
        terrain.grain = 1.0F;
        ground.list.size = {400, 300};
        const double pixel = static_cast<double>(metres_a_pixel(ground.list.camera, {400, 300}).y);
        const double last = 10.0 * spacing / 4.0 / pixel;
        EXPECT_TRUE(shows_grain(ground.list, terrain, 0.99 * last));
        EXPECT_FALSE(shows_grain(ground.list, terrain, 1.01 * last));
        terrain.grain = 0.0F;
        EXPECT_FALSE(shows_grain(ground.list, terrain, 0.0));
    }
}

// From every eye, a place has the same grain: patterns do not swim.
TEST(GrainView, APlaceHasTheSameGrainFromEveryEye) {
    Ground ground({3.0, 2.0});
    test::Chance chance(31);
    for (int i = 0; i < cases; ++i) {
        const auto anywhere = [&](double reach) {
            return glm::dvec3(chance.between(-reach, reach), chance.between(-reach, reach),
                              chance.between(0.0, 50.0));
        };
        const glm::dvec3 place = anywhere(90.0);
        const auto in_pattern = [&](glm::dvec3 eye, std::size_t pattern) {
            const GrainView view = ground.from(eye);
            return glm::dvec3(view.patterns[pattern]) +
                   turned(place - eye) * static_cast<double>(view.patterns[pattern].w);
        };
        const glm::dvec3 one_eye = place + 0.01 * anywhere(90.0);
        const glm::dvec3 other_eye = place + anywhere(2.0);
        for (std::size_t pattern = 0; pattern < 2; ++pattern) {
            const glm::dvec3 way = in_pattern(one_eye, pattern) - in_pattern(other_eye, pattern);
            const double copies = pattern == 0 ? GrainView::copies : 1.0;
            const glm::dvec3 off = glm::abs(way - copies * glm::round(way / copies));
            EXPECT_LT(std::max({off.x, off.y, off.z}), 2e-5);
        }
    }
}

TEST(GrainView, TurnsWithoutStretching) {
    test::Chance chance(32);
    for (int i = 0; i < cases; ++i) {
        const glm::dvec3 a(chance.between(-1.0, 1.0), chance.between(-1.0, 1.0),
                           chance.between(-1.0, 1.0));
        const glm::dvec3 b(chance.between(-1.0, 1.0), chance.between(-1.0, 1.0),
                           chance.between(-1.0, 1.0));
        // GrainView::turn are floats.
        EXPECT_NEAR(glm::dot(turned(a), turned(b)), glm::dot(a, b), 1e-6);
        EXPECT_EQ(turned(a).z, a.z);
    }
}

TEST(GrainView, KnowsTheMetresOfASample) {
    for (const double exaggeration : {1.0, 3.0}) {
        const GrainView view = Ground({3.0, 2.0}, exaggeration).from({10.0, -20.0, 5.0});
        const glm::dmat3 expected(turned({3.0, 0.0, 0.0}), turned({0.0, -2.0, 0.0}),
                                  turned({0.0, 0.0, exaggeration}));
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_LT(glm::distance(view.metres_per_sample[axis], expected[axis]), 1e-6);
        }
        EXPECT_EQ(view.up, glm::vec3(0.0F, 0.0F, 1.0F));
    }
}

// As the ramp: 2800 m in the Alps, where terrains without a place are taken to be.
TEST(GrainView, HasSnowWhereTheRampHas) {
    const auto snow_line = [](const char* ramp, bool has_image) {
        scene::Scene scene;
        terrain::Terrain terrain;
        terrain.heightfield = test::plane_heightfield(test::hills(65, 33, 20.0), {3.0, 2.0});
        if (has_image) {
            terrain.color = Image(65, 33, {90, 120, 60, 255});
        }
        scene::TerrainOptions options;
        options.ramp = terrain::named_ramp(ramp).value();
        const auto surface = scene::TerrainSurface::create(
            std::make_shared<const terrain::Terrain>(std::move(terrain)), options);
        scene::TerrainNode node;
        node.surface = std::make_shared<const scene::TerrainSurface>(surface.value());
        return grain_view(DrawList(), node, glm::dmat4(1.0)).snow.w;
    };
    EXPECT_EQ(snow_line("relief", false), 2800.0F);
    EXPECT_GT(snow_line("desert", false), 1e9F);
    EXPECT_GT(snow_line("relief", true), 1e9F);
}

} // namespace
} // namespace reljef::view
