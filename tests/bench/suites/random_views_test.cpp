#include "bench/suites/random_views.h"

#include <memory>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/terrain/made_bisection.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::bench {
namespace {

TEST(RandomViews, ThoseOfAContinuedRunAreThoseOfAWholeOne) {
    ViewGenerators whole(7, 0);
    ViewGenerators continued(7, 3);
    for (int i = 0; i < 20; ++i) {
        auto expected = whole.next();
        auto found = continued.next();
        ASSERT_TRUE(expected);
        ASSERT_EQ(found.has_value(), i >= 3);
        if (found) {
            EXPECT_EQ(*found, *expected) << i;
        }
    }
    EXPECT_NE(*ViewGenerators(7, 0).next(), *ViewGenerators(8, 0).next());
}

std::vector<scene::TerrainSurface> surfaces() {
    std::vector<scene::TerrainSurface> found;
    for (const terrain::Heightfield& heightfield :
         {test::plane_heightfield(test::rough_hills(80, 60, 1), {30.0, 30.0}),
          test::geographic_heightfield(test::rough_hills(80, 60, 2), 46.0, 7.0, 0.01),
          test::closed_globe(40, 0.5, 0.5, 3)}) {
        scene::TerrainOptions options;
        options.placement = test::placed(heightfield).kind();
        auto ground = std::make_shared<terrain::Terrain>();
        ground->heightfield = heightfield;
        found.push_back(scene::TerrainSurface::create(std::move(ground), options).value());
    }
    return found;
}

// Metres of the eye above the ground below it.
double height_above(const scene::TerrainSurface& surface, glm::dvec3 eye) {
    const auto& placement = surface.placement();
    const glm::dvec3 sample = placement.sample_from_world(eye).value();
    return sample.z -
           terrain::bilinear_height(surface.heightfield().heights.view(), glm::dvec2(sample));
}

TEST(RandomViews, NearTheGroundAreWithinThreeMetresOfItOnThePlaneAndOnTheEarth) {
    for (const scene::TerrainSurface& surface : surfaces()) {
        ViewGenerators generators(1, 0);
        for (int i = 0; i < 200; ++i) {
            std::mt19937 random = *generators.next();
            const scene::Camera camera = view_near_the_ground(random, surface);
            const double above = height_above(surface, camera.eye);
            EXPECT_GT(above, 0.299);
            EXPECT_LT(above, 3.001);
            const glm::dvec3 ahead = glm::normalize(camera.target - camera.eye);
            const double sine = glm::dot(ahead, surface.placement().up(camera.eye));
            EXPECT_GT(sine, -0.5001);
            EXPECT_LT(sine, 0.0873);
            EXPECT_LT(camera.near, above);
        }
    }
}

TEST(RandomViews, AreAboveTheGround) {
    for (const scene::TerrainSurface& surface : surfaces()) {
        ViewGenerators generators(2, 0);
        for (int i = 0; i < 200; ++i) {
            std::mt19937 random = *generators.next();
            const scene::Camera camera = random_view(random, surface);
            const bool is_plane = surface.placement().kind() == terrain::PlacementKind::plane;
            if (!is_plane) {
                EXPECT_GT(height_above(surface, camera.eye), 0.0);
            }
            EXPECT_NE(camera.target, camera.eye);
        }
    }
}

} // namespace
} // namespace reljef::bench
