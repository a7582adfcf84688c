#include "engine/truth/hidden_places.h"

#include <limits>

#include <gtest/gtest.h>

#include "tests/terrain/made_heightfield.h"

namespace reljef::truth {
namespace {

constexpr int side = 129;

// A surface on a plane of one metre a sample, where it stands, and who looks at it.
struct Stage {
    explicit Stage(Grid<float> heights)
        : heightfield(test::plane_heightfield(std::move(heights))),
          placement(test::placed(heightfield)), pyramid(heightfield.heights.view()),
          caster(heightfield.heights.view(), pyramid, placement) {}
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;

    [[nodiscard]] SurfaceView view() const {
        return {heightfield.heights.view(), placement, glm::dmat4(1.0), camera};
    }
    [[nodiscard]] glm::dvec3 at(double col, double row, double height) const {
        return placement.world_from_sample({col, row, height});
    }
    /// What rays through the pixels meet, or, `flat`, the places at height 0.
    [[nodiscard]] HitBuffer hits(glm::ivec2 size, bool flat) const {
        HitBuffer hits(size.x, size.y);
        for (int row = 0; row < size.y; ++row) {
            for (int col = 0; col < size.x; ++col) {
                const Ray ray = scene::view_ray(camera, size, glm::dvec2(col, row) + 0.5);
                hits(col, row) = flat ? flat_hit(ray) : exact_hit(ray);
            }
        }
        return hits;
    }
    [[nodiscard]] Hit exact_hit(const Ray& ray) const {
        const auto hit = caster.first_hit(ray);
        return hit ? Hit{static_cast<float>(hit->sample.x), static_cast<float>(hit->sample.y), 0.0F,
                         static_cast<float>(hit->t)}
                   : Hit{};
    }
    [[nodiscard]] Hit flat_hit(const Ray& ray) const {
        const glm::dvec3 origin = at(0.0, 0.0, 0.0);
        const double t = (origin.z - ray.origin.z) / ray.direction.z;
        const glm::dvec3 offset = ray.origin + t * ray.direction - origin;
        const glm::dvec2 place(offset.x, -offset.y); // rows run south
        const bool is_inside = t > 0.0 && place.x >= 0.0 && place.y >= 0.0 && place.x <= side - 1 &&
                               place.y <= side - 1;
        return is_inside ? Hit{static_cast<float>(place.x), static_cast<float>(place.y), 0.0F,
                               static_cast<float>(t)}
                         : Hit{};
    }

    terrain::Heightfield heightfield;
    terrain::Placement placement;
    terrain::MinMaxPyramid pyramid;
    terrain::SurfaceCaster caster;
    scene::Camera camera;
};

// A wall 5 m high at column 40, seen along the rows from 10 m above column 10: it hides the ground
// as far as column 70.
TEST(HiddenPlaces, OfAWallAreThoseInItsShadow) {
    Stage stage(
        test::made_heights(side, side, [](int col, int) { return col == 40 ? 5.0F : 0.0F; }));
    stage.camera.eye = stage.at(10.0, 64.0, 10.0);
    stage.camera.target = stage.at(60.0, 64.0, 0.0);
    const glm::ivec2 size(64, 64);
    const HitBuffer flat = stage.hits(size, true);
    std::size_t shown = 0;
    std::size_t surely_hidden = 0;
    std::size_t perhaps_hidden = 0;
    for (const Hit& hit : flat.samples()) {
        shown += shows_terrain(hit) ? 1U : 0U;
        // Places of the wall itself, and two texels at the ends, are left out.
        surely_hidden += hit.col > 43.0F && hit.col < 68.0F ? 1U : 0U;
        perhaps_hidden += hit.col > 39.0F && hit.col < 72.0F ? 1U : 0U;
    }
    ASSERT_GT(surely_hidden, 100U);
    const ShownPlaces places = hidden_places(stage.view(), stage.caster, flat);
    EXPECT_EQ(places.shown, shown);
    EXPECT_GE(places.hidden, surely_hidden);
    EXPECT_LE(places.hidden, perhaps_hidden);
    EXPECT_DOUBLE_EQ(places.hidden_percent(), 100.0 * static_cast<double>(places.hidden) /
                                                  static_cast<double>(places.shown));
}

// Of rough ground, seen in perspective and orthographically, from ten places.
TEST(HiddenPlaces, DoNotExistWhereRaysMeetTheSurface) {
    for (unsigned seed = 0; seed < 10; ++seed) {
        Stage stage(test::random_heights(side, side, 0.0F, 6.0F, seed));
        stage.camera.eye = stage.at(10.0 + seed, 20.0 + 9.0 * seed, 12.0 + 3.0 * seed);
        stage.camera.target = stage.at(64.0, 64.0, 0.0);
        stage.camera.view_height = 60.0;
        stage.camera.projection = seed % 2 == 0 ? scene::ProjectionKind::perspective
                                                : scene::ProjectionKind::orthographic;
        const ShownPlaces places =
            hidden_places(stage.view(), stage.caster, stage.hits({48, 48}, false));
        EXPECT_GT(places.shown, 500U);
        EXPECT_EQ(places.hidden, 0U) << seed;
    }
}

TEST(HiddenPlaces, CountPlacesBehindTheEyeAndNoNumbersButNeitherSkyNorMeshes) {
    Stage stage(test::made_heights(side, side, [](int, int) { return 0.0F; }));
    stage.camera.eye = stage.at(64.0, 64.0, 10.0);
    stage.camera.target = stage.at(100.0, 64.0, 0.0);
    HitBuffer hits(5, 1);
    hits(0, 0) = {10.0F, 64.0F, 0.0F, 1.0F};
    hits(1, 0) = {std::numeric_limits<float>::quiet_NaN(), 64.0F, 0.0F, 1.0F};
    hits(2, 0) = {-1.0F, -1.0F, 0.0F, 1.0F};
    hits(3, 0) = {100.0F, 64.0F, 0.0F, 1.0F};
    const ShownPlaces places = hidden_places(stage.view(), stage.caster, hits);
    EXPECT_EQ(places.shown, 3U);
    EXPECT_EQ(places.hidden, 2U);
    EXPECT_EQ(hidden_places(stage.view(), stage.caster, HitBuffer(4, 4)).hidden_percent(), 0.0);
}

} // namespace
} // namespace reljef::truth
