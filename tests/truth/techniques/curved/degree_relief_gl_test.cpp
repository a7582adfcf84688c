// Relief techniques where rays are mapped place by place: around poles, and over large parts of the
// Earth.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "tests/render/driver_fixture.h"
#include "tests/render/earth_stage.h"
#include "tests/render/made_stream.h"
#include "tests/scene/streaming/streamed_samples.h"
#include "tests/support/release_only.h"
#include "tests/truth/techniques/curved/lit_pixels.h"

namespace reljef::render {
namespace {

using test::EarthStage;

constexpr glm::ivec2 small_size{128, 96};

// What is seen from where, degrees and metres.
struct DegreeView {
    geo::Geodetic place;
    double azimuth = 0.0;
    double down = 20.0;
};

std::string name_of(const DegreeView& view) {
    return fmt::format("{}, {}, {} m, to {}, {} down", view.place.latitude, view.place.longitude,
                       view.place.height, view.azimuth, view.down);
}

class DegreeReliefGlTest : public DriverGlTest {
protected:
    static void look(EarthStage& stage, const DegreeView& view) {
        stage.look_from(view.place, view.azimuth, view.down);
    }

    // The Earth around 30 degrees east, with north above.
    static void look_at_map(EarthStage& stage, double latitude, double view_height) {
        const terrain::Placement& placement = stage.surface().placement();
        scene::Camera camera;
        camera.projection = scene::ProjectionKind::orthographic;
        camera.view_height = view_height;
        camera.eye = placement.world_from_geodetic({latitude, 30.0, 2e4}).value();
        camera.target = placement.world_from_geodetic({latitude, 30.0, 0.0}).value();
        camera.up = placement.north(camera.eye);
        camera.orthographic_near = -1e7;
        camera.orthographic_far = 1e7;
        stage.look(camera);
    }

    view::DrawnHits hits(EarthStage& stage, const std::string& technique) {
        stage.set(test::must(scene::parse_technique(technique)));
        const view::FrameView frame = view::select(stage.scene, small_size);
        EXPECT_EQ(frame.list.stats.reliefs_as_triangles, 0);
        EXPECT_TRUE(!frame.list.terrains.empty() && frame.list.terrains.front().search &&
                    frame.list.terrains.front().search->course &&
                    frame.list.terrains.front().search->course->degrees);
        return test::must(driver_of_all().draw_hits(frame));
    }

    void expect_true(EarthStage& stage, const std::string& technique, const std::string& name) {
        const view::DrawnHits shown = hits(stage, technique);
        const truth::GeometricErrors found = stage.errors(shown.hits);
        ASSERT_TRUE(found.reprojection.distribution) << name;
        EXPECT_GT(found.reprojection.distribution->count, shown.hits.size() / 50) << name;
        // Where the truth of a pixel is not stable, the next ridge may be hit.
        EXPECT_LE(found.wrong + found.holes + found.reprojection.unbounded, shown.hits.size() / 500)
            << technique << ", " << name << ": " << found.wrong << " wrong, " << found.holes
            << " holes, " << found.reprojection.unbounded;
        EXPECT_LT(found.reprojection.distribution->p99, 0.02) << technique << ", " << name;
    }

    Driver& driver_of_all() {
        if (!driver_) {
            driver_ = test::must(Driver::create({.size = small_size, .shader_dir = {}}));
        }
        return *driver_;
    }

private:
    std::optional<Driver> driver_;
};

// A cap of 2.57 degrees, 1.43 of them all around.
EarthStage beside_pole(double latitude, double step = 0.01, double turn = 0.0) {
    return EarthStage({.latitude = latitude, .step = step, .turn = turn});
}

TEST_F(DegreeReliefGlTest, ExactAndConeShowTheTrueFirstHitBesideAPole) {
    for (const double latitude : {90.0, 89.95, -87.43}) {
        EarthStage stage = beside_pole(latitude);
        for (const double above : {30.0, 3e3, 1e4}) {
            stage.look({120.3, 100.7}, above, {140.0, latitude > 0.0 ? 10.0 : 240.0});
            for (const char* const technique : {"exact", "cone:n=1024,step=0"}) {
                expect_true(stage, technique, fmt::format("{}, {} m above", latitude, above));
            }
        }
    }
}

TEST_F(DegreeReliefGlTest, ExactShowsTheTrueFirstHitOfAGlobeFromAnywhere) {
    EarthStage stage(test::closed_globe(300, 0.5, 1.0, 11),
                     {.placement = terrain::PlacementKind::ellipsoid});
    for (const DegreeView& view :
         {DegreeView{{89.0, 20.0, 3e4}, 10.0, 20.0}, DegreeView{{-89.9, -100.0, 3e4}, 200.0, 40.0},
          DegreeView{{90.0, 0.0, 1e6}, 0.0, 90.0}, DegreeView{{80.0, 179.0, 3e5}, 30.0, 30.0},
          DegreeView{{10.0, 179.9, 3e5}, 90.0, 40.0}, DegreeView{{-35.0, -179.0, 3e6}, 270.0, 60.0},
          DegreeView{{45.0, 7.0, 1e7}, 0.0, 90.0}, DegreeView{{0.0, 180.0, 1e7}, 0.0, 80.0}}) {
        look(stage, view);
        expect_true(stage, "exact", name_of(view));
    }
}

// Chords grow with the distance, and rays that meet the axis do not turn.
TEST_F(DegreeReliefGlTest, ExactAndConeShowTheTrueFirstHitFromAPoleNearTheGround) {
    terrain::Heightfield globe = test::closed_globe(300, 0.5, 1.0, 11);
    globe.heights = test::made_heights(globe.heights.cols(), globe.heights.rows(),
                                       [](int, int row) { return 50.0 * (row % 5); });
    const double ground = globe.heights(0, 0); // of the poles: 302 rows follow the first
    EarthStage stage(std::move(globe), {.placement = terrain::PlacementKind::ellipsoid});
    for (const double latitude : {90.0, 89.9999, -90.0}) {
        for (const double fov : {57.0, 5.0}) {
            look(stage, {{latitude, 0.0, ground + (latitude > 0.0 ? 2.0 : 102.0)}, 30.0, 1.0});
            scene::Camera camera = stage.scene.camera();
            camera.vertical_fov = fov;
            stage.look(camera);
            for (const char* const technique : {"exact", "cone:n=1024,step=0"}) {
                expect_true(stage, technique, fmt::format("{} with {} degrees", latitude, fov));
            }
        }
    }
}

TEST_F(DegreeReliefGlTest, ExactShowsTheTrueFirstHitOnMaps) {
    EarthStage stage(test::closed_globe(300, 0.5, 1.0, 11),
                     {.placement = terrain::PlacementKind::ellipsoid});
    for (const double latitude : {90.0, 50.0, -89.0}) {
        for (const double height : {3e5, 1.4e7}) {
            look_at_map(stage, latitude, height);
            expect_true(stage, "exact", fmt::format("map of {} m at {}", height, latitude));
        }
    }
}

// Floats of a place are rounded by more than the surface is thick.
TEST_F(DegreeReliefGlTest, FlatGroundHasNoHoles) {
    for (const float relief : {0.0F, 20.0F, 2000.0F}) {
        terrain::Heightfield globe = test::closed_globe(60, 0.5, 1.0, 11);
        globe.heights =
            test::made_heights(globe.heights.cols(), globe.heights.rows(),
                               [&](int col, int) { return col % 7 == 3 ? relief : 0.0F; });
        EarthStage stage(std::move(globe), {.placement = terrain::PlacementKind::ellipsoid});
        const auto expect_no_holes = [&](const std::string& name) {
            for (const char* const technique : {"exact", "relief"}) {
                EXPECT_LE(stage.errors(hits(stage, technique).hits).holes, 1U)
                    << technique << ", " << relief << " m, " << name;
            }
        };
        for (const double height : {3e3, 3e5, 1e7}) {
            look(stage, {{80.0, 30.0, height}, 0.0, 60.0});
            expect_no_holes(fmt::format("from {} m", height));
        }
        for (const double view_height : {3e5, 1.4e7}) {
            look_at_map(stage, 50.0, view_height);
            expect_no_holes(fmt::format("map of {} m", view_height));
        }
    }
}

// Steps and parallax, too: a range of steps may begin before it and end behind it.
TEST_F(DegreeReliefGlTest, NoTechniqueHasHolesWhereLongitudesBeginAnew) {
    EarthStage stage(test::closed_globe(300, 0.5, 1.0, 11),
                     {.placement = terrain::PlacementKind::ellipsoid});
    look(stage, {{20.0, 172.0, 2e6}, 0.0, 90.0}); // at ground alone
    for (const char* const technique :
         {"exact", "cone", "relief", "steep", "interval", "pom", "parallax", "parallax-iterated"}) {
        EXPECT_EQ(stage.errors(hits(stage, technique).hits).holes, 0U) << technique;
    }
}

// Floats of its columns have fewer digits, so a ray may come out of it below the surface.
TEST_F(DegreeReliefGlTest, GroundNearWhereLongitudesBeginAnewHasNoHoles) {
    EarthStage stage(test::closed_globe(300, 0.5, 1.0, 11),
                     {.placement = terrain::PlacementKind::ellipsoid});
    std::size_t holes = 0;
    for (double latitude = -60.0; latitude < 65.0; latitude += test::cases(16, 8)) {
        look(stage, {{latitude, 179.6, 4e4}, 90.0, 45.0}); // across it, at ground alone
        holes += stage.errors(hits(stage, "exact").hits).holes;
    }
    EXPECT_EQ(holes, 0U);
}

TEST_F(DegreeReliefGlTest, ExactShowsTheTrueFirstHitOfAStreamedGlobe) {
    EarthStage stage(test::closed_globe(300, 0.5, 1.0, 11),
                     {.placement = terrain::PlacementKind::ellipsoid});
    test::stream_samples(*stage.terrain->get<scene::TerrainNode>(), test::SeenLevels::finest);
    stage.set(test::must(scene::parse_technique("exact")));
    for (const DegreeView& view :
         {DegreeView{{89.0, 20.0, 3e4}, 10.0, 20.0}, DegreeView{{-89.9, -100.0, 3e4}, 200.0, 40.0},
          DegreeView{{10.0, 179.9, 3e5}, 90.0, 40.0}, DegreeView{{45.0, 7.0, 1e6}, 0.0, 40.0}}) {
        look(stage, view);
        bring_tiles(stage.scene, small_size);
        expect_true(stage, "exact", name_of(view));
    }
}

TEST_F(DegreeReliefGlTest, HardShadowIsTheShadowRayOfTheTruth) {
    EarthStage stage(test::closed_globe(300, 0.5, 1.0, 11),
                     {.placement = terrain::PlacementKind::ellipsoid});
    look(stage, {{86.0, 20.0, 2e5}, 10.0, 40.0});
    const glm::dvec3 up = stage.surface().placement().up(stage.scene.camera().eye);
    const glm::dvec3 to_sun = glm::normalize(0.15 * up + glm::dvec3(up.y, -up.x, 0.0)); // low
    const scene::Light sun{glm::degrees(std::atan2(to_sun.x, to_sun.y)),
                           glm::degrees(std::asin(to_sun.z)), glm::vec3(1.0F), glm::vec3(0.0F)};
    stage.scene.add_light(sun);
    stage.set(test::must(scene::parse_technique("exact:shadow=hard")));
    test::must(driver_of_all().draw(view::select(stage.scene, small_size)));
    const Image shown = driver_of_all().read_color();
    const auto lit = test::lit_pixels(stage, small_size);
    EXPECT_GT(test::count_of(lit, true), 500U);
    EXPECT_GT(test::count_of(lit, false), 100U);
    EXPECT_LE(test::wrongly_lit(lit, shown), 0.5);
}

// Samples are there twenty times as close along rows.
TEST_F(DegreeReliefGlTest, LightIsNotBlurredBesideAPole) {
    constexpr int finer = 4;
    constexpr int side = EarthStage::side;
    EarthStage stage({.latitude = 90.0, .step = 0.01},
                     test::made_heights(side, side, [](int, int row) {
                         return 900.0 + 300.0 * std::sin(0.8 * row);
                     }));
    stage.scene.add_light({0.0, 30.0, glm::vec3(1.0F), glm::vec3(0.2F)});
    stage.look({120.3, 150.7}, 6e3, {140.0, 30.0});
    stage.set(test::must(scene::parse_technique("exact")));
    const auto picture = [&](glm::ivec2 size) {
        Driver driver = test::must(Driver::create({.size = size, .shader_dir = {}}));
        test::must(driver.draw(view::select(stage.scene, size)));
        return driver.read_color();
    };
    const Image shown = picture(small_size);
    const Image fine = picture(finer * small_size);
    double difference = 0.0;
    for (int row = 0; row < small_size.y; ++row) {
        for (int col = 0; col < small_size.x; ++col) {
            int sum = 0;
            for (int i = 0; i < finer * finer; ++i) {
                sum += brightness(fine(finer * col + i % finer, finer * row + i / finer));
            }
            difference += std::abs(brightness(shown(col, row)) - sum / (finer * finer));
        }
    }

    EXPECT_LT(difference / (3.0 * small_size.x * small_size.y), 0.9);
}

} // namespace
} // namespace reljef::render
