#include "engine/view/select.h"

#include <cmath>
#include <cstring>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "tests/render/driver_fixture.h"
#include "tests/render/made_stream.h"
#include "tests/scene/streaming/streamed_samples.h"
#include "tests/session/made_session.h"
#include "tests/support/release_only.h"
#include "tests/terrain/chance.h"

namespace reljef::render {
namespace {

// Ridges one behind the other, 15 tiles.
terrain::Heightfield ridged(unsigned seed) {
    const Grid<float> noise = test::random_heights(600, 300, -2.0F, 2.0F, seed);
    return test::plane_heightfield(test::made_heights(600, 300,
                                                      [&](int col, int row) {
                                                          return 90.0 * std::sin(col / 17.0) +
                                                                 20.0 * std::sin(row / 40.0) +
                                                                 noise(col, row);
                                                      }),
                                   {6.0, 6.0});
}

Camera low_view(test::Chance& chance, const scene::TerrainSurface& surface) {
    const Box& bounds = surface.bounds();
    const double x = chance.between(0.9 * bounds.low.x, 0.9 * bounds.high.x);
    const double y = chance.between(0.9 * bounds.low.y, 0.9 * bounds.high.y);
    const double ground = surface.height_at(x, y).value();
    Camera camera =
        camera_at({x, y, ground + chance.between(0.5, 40.0)},
                  {chance.between(bounds.low.x, bounds.high.x),
                   chance.between(bounds.low.y, bounds.high.y), ground + chance.between(-20, 20)});
    camera.near = 0.01;
    return camera;
}

// The same ground on the Earth, with cells of 6 and of 200 m.
terrain::Heightfield ridged_on_earth(unsigned seed, double degrees) {
    const double steeper = degrees / 6e-5;
    Grid<float> heights = ridged(seed).heights;
    for (float& height : heights.samples()) {
        height *= static_cast<float>(steeper);
    }
    return test::geographic_heightfield(std::move(heights), 46.0, 7.0, degrees);
}

Camera low_view_on_earth(test::Chance& chance, const scene::TerrainSurface& surface) {
    const auto& heights = surface.heightfield().heights;
    const auto anywhere = [&](double above) {
        const glm::dvec2 sample(chance.between(20.0, heights.cols() - 21.0),
                                chance.between(20.0, heights.rows() - 21.0));
        const double height = terrain::bilinear_height(heights.view(), sample);
        return surface.placement().world_from_sample({sample, height + above});
    };
    const double cells = surface.heightfield().spacing.y; // metres
    Camera camera = camera_at(anywhere(cells * chance.between(0.1, 7.0)), anywhere(0.0));
    camera.near = 0.01;
    return camera;
}

// From 200 to 20,000 km above a globe, towards it.
Camera view_of_globe(test::Chance& chance, const scene::TerrainSurface& surface) {
    const auto& heights = surface.heightfield().heights;
    const auto anywhere = [&](double above) {
        return surface.placement().world_from_sample({chance.between(0.0, heights.cols() - 1.0),
                                                      chance.between(0.0, heights.rows() - 1.0),
                                                      above});
    };
    Camera camera =
        camera_at(anywhere(2e5 * std::pow(100.0, chance.between(0.0, 1.0))), 0.3 * anywhere(0.0));
    camera.near = 1e3;
    return camera;
}

bool same_bits(const HitBuffer& a, const HitBuffer& b) {
    return a.size() == b.size() &&
           std::memcmp(a.samples().data(), b.samples().data(), a.samples().size_bytes()) == 0;
}

class Occlusion : public DriverGlTest, public testing::WithParamInterface<test::SampleSource> {
protected:
    // Drawn with and without: the same bits, of colours and of hits. Returns the tiles left out.
    int compare(const std::string& technique, int views, unsigned seed) {
        return compare(technique, views, seed, ridged(seed), low_view);
    }

    int compare(const std::string& technique, int views, unsigned seed,
                terrain::Heightfield heightfield,
                Camera (*any_view)(test::Chance&, const scene::TerrainSurface&)) {
        Scene scene;
        Node& terrain = test::add_terrain(scene, std::move(heightfield));
        test::give_samples(*terrain.get<scene::TerrainNode>(), GetParam());
        Node& camera = scene.add_camera();
        scene.add_light();
        scene.set_sky({});
        terrain.get<scene::TerrainNode>()->material.technique =
            scene::parse_technique(technique).value();
        session::SceneRenderer with = driver();
        session::SceneRenderer without =
            test::must(test::make_renderer(size, {.occlusion = false}));
        test::Chance chance(seed);
        int occluded = 0;
        for (int i = 0; i < views; ++i) {
            *camera.get<Camera>() = any_view(chance, surface_of(terrain));
            bring_tiles(scene);
            occluded += test::must(with.draw(scene)).skipped.tiles_occluded;
            bring_tiles(scene, size, {.occlusion = false});
            EXPECT_EQ(test::must(without.draw(scene)).skipped.tiles_occluded, 0);
            EXPECT_EQ(with.read_color(), without.read_color()) << technique << ' ' << i;
            EXPECT_TRUE(
                same_bits(test::must(with.draw_hits(scene)), test::must(without.draw_hits(scene))))
                << technique << ' ' << i;
        }
        return occluded;
    }

    // Random views.
    const int many = test::cases(6, 20);
    const int some = test::cases(3, 10);
};

INSTANTIATE_TEST_SUITE_P(Sources, Occlusion, test::all_sources(), test::name_of_source);

TEST_P(Occlusion, ThePictureIsTheSameToTheBitWhereTilesAreLeftOut) {
    EXPECT_GT(compare("polygons:error=1", many, 1), many / 2);
    EXPECT_GT(compare("polygons:error=4", some, 2), some / 3);
    EXPECT_GT(compare("polygons", 6, 3), 3);
}

TEST_P(Occlusion, ThePictureIsTheSameWhereNearerGroundOfTheEarthHidesTiles) {
    EXPECT_GT(compare("polygons:error=1", many, 10, ridged_on_earth(10, 6e-5), low_view_on_earth),
              many / 2);
    EXPECT_GT(compare("polygons:error=1", some, 11, ridged_on_earth(11, 2e-3), low_view_on_earth),
              some / 3);
    EXPECT_GT(compare("polygons", 6, 12, ridged_on_earth(12, 6e-5), low_view_on_earth), 3);
}

TEST_P(Occlusion, ThePictureOfAGlobeIsTheSameWithoutItsFarSide) {
    EXPECT_GT(
        compare("polygons:error=1", 8, 7, test::closed_globe(400, 0.5, 0.5, 7), view_of_globe), 50);
    const int far_tiles = GetParam() == test::SampleSource::memory ? 20 : 2; // coarse ones: few
    EXPECT_GT(
        compare("polygons:error=8", 8, 8, test::closed_globe(300, 0.0, 0.5, 8), view_of_globe),
        far_tiles);
    EXPECT_GT(compare("polygons", 2, 9, test::closed_globe(300, 1.0, 1.0, 9), view_of_globe), 5);
}

TEST_P(Occlusion, NothingIsLeftOutWhereLevelsGoByDistanceOrNothingIsSolid) {
    EXPECT_EQ(compare("polygons:lods=4", 3, 4), 0);
    EXPECT_EQ(compare("texture", 3, 5), 0);
}

TEST(OcclusionList, FlatViewsOfAMapLeaveNothingOut) {
    Scene scene;
    test::add_terrain(scene, ridged(6));
    Camera camera = camera_at({0, 0, 500}, {0, 10, 0});
    camera.projection = scene::ProjectionKind::orthographic;
    scene.add_camera(camera);
    const view::DrawList fewer = view::select(scene, size).list;
    const view::DrawList all = view::select(scene, size, {.occlusion = false}).list;
    EXPECT_EQ(fewer.tiles.size(), all.tiles.size());
}

} // namespace
} // namespace reljef::render
