#include "engine/cast/curved_rays.h"

#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "engine/cast/driver.h"
#include "tests/gl/gl_fixture.h"
#include "tests/render/earth_stage.h"

namespace reljef::cast {
namespace {

constexpr glm::ivec2 curved_size{320, 240};
struct EarthStage : test::EarthStage {
    explicit EarthStage(const test::EarthPlace& place) : test::EarthStage(place) {
        scene::Polygons bounded;
        bounded.error = 1.0;
        set(scene::Technique{bounded});
    }

    [[nodiscard]] view::DrawnHits drawn() const {
        Driver driver = test::must(Driver::create({.size = curved_size}));
        return test::must(driver.draw_hits(view::select(scene, curved_size)));
    }

    void expect_true(const std::string& name, double most) const {
        const view::DrawnHits shown = drawn();
        const truth::GeometricErrors found = errors(shown.hits);
        ASSERT_TRUE(found.reprojection.distribution && shown.stats.kept_error) << name;
        EXPECT_GT(found.reprojection.distribution->count, shown.hits.size() / 50) << name;
        // Where the truth of a pixel is not stable, the next ridge may be hit.
        EXPECT_LE(found.wrong + found.holes + found.reprojection.unbounded,
                  shown.hits.size() / 2000)
            << name;
        EXPECT_LT(found.reprojection.distribution->p99, most) << name;
        EXPECT_LT(found.reprojection.distribution->p99, *shown.stats.kept_error) << name;
        EXPECT_LT(*shown.stats.kept_error, 10.0 * most) << name;
    }
};

TEST(CurvedRays, HitWhatTheTruthHits) {
    for (const double latitude : {45.0, 0.1, -60.0, 85.0}) {
        for (const double above : {0.3, 30.0, 3e3, 2e4}) {
            EarthStage stage({.latitude = latitude, .turn = latitude > 0.0 ? 20.0 : 0.0});
            stage.look({120.3, 201.7}, above, {140.0, 40.0});
            stage.expect_true(fmt::format("latitude {}, {} m above", latitude, above),
                              std::abs(latitude) > 80.0 ? 0.05 : 0.01);
        }
    }
}

TEST(CurvedRays, FromFarAwayAreLeftToOpenGl) {
    EarthStage stage({});
    stage.look({120.3, 201.7}, 3e6, {140.0, 40.0});
    EXPECT_NE(obstacle_of(view::select(stage.scene, curved_size).list), "");
    stage.look({120.3, 201.7}, 2e4, {140.0, 40.0});
    EXPECT_EQ(obstacle_of(view::select(stage.scene, curved_size).list), "");
}

} // namespace
} // namespace reljef::cast
