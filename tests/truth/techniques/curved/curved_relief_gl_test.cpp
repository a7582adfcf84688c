// Relief techniques on the ellipsoid, where view rays are bent in samples.
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "tests/render/driver_fixture.h"
#include "tests/render/earth_stage.h"
#include "tests/support/release_only.h"
#include "tests/truth/techniques/curved/lit_pixels.h"

namespace reljef::render {
namespace {

using test::EarthPlace;
using test::EarthStage;

// Pixels are compared one by one with the truth's rays: a quarter of the other tests' do.
constexpr glm::ivec2 curved_size{160, 120};

class CurvedReliefGlTest : public DriverGlTest {
protected:
    view::DrawnHits hits(EarthStage& stage, const std::string& technique) {
        stage.set(test::must(scene::parse_technique(technique)));
        return test::must(driver_of_all().draw_hits(view::select(stage.scene, curved_size)));
    }

    Image picture(EarthStage& stage, const std::string& technique) {
        Driver& driver = driver_of_all();
        stage.set(test::must(scene::parse_technique(technique)));
        const view::FrameView frame = view::select(stage.scene, curved_size);
        EXPECT_EQ(frame.list.stats.reliefs_as_triangles, 0);
        test::must(driver.draw(frame));
        return driver.read_color();
    }

    void expect_true(EarthStage& stage, const std::string& technique, const std::string& name,
                     double most = 0.05) {
        const view::DrawnHits shown = hits(stage, technique);
        ASSERT_EQ(shown.stats.reliefs_as_triangles, 0) << name;
        const truth::GeometricErrors found = stage.errors(shown.hits);
        ASSERT_TRUE(found.reprojection.distribution) << name;
        EXPECT_GT(found.reprojection.distribution->count, shown.hits.size() / 50) << name;
        // Where the truth of a pixel is not stable, the next ridge may be hit.
        EXPECT_LE(found.wrong + found.holes + found.reprojection.unbounded,
                  shown.hits.size() / 1000)
            << name << ": " << found.wrong << " wrong, " << found.holes << " holes, "
            << found.reprojection.unbounded;
        EXPECT_LT(found.reprojection.distribution->p99, most) << name;
    }

private:
    // One for all stages of a test: programs are compiled once.
    Driver& driver_of_all() {
        if (!driver_) {
            driver_ = test::must(Driver::create({.size = curved_size, .shader_dir = {}}));
        }
        return *driver_;
    }

    std::optional<Driver> driver_;
};

TEST_F(CurvedReliefGlTest, ExactAndConeShowTheTrueFirstHit) {
    for (const double latitude : {45.0, 0.1, -60.0, 85.0}) {
        EarthStage stage({.latitude = latitude, .turn = latitude > 0.0 ? 20.0 : 0.0});
        for (const double above : {0.3, 30.0, 3e3, 2e4}) {
            stage.look({120.3, 201.7}, above, {140.0, 40.0});
            for (const char* const technique : {"exact", "cone:n=1024,step=0"}) {
                expect_true(stage, technique,
                            fmt::format("{} at {}, {} m above", technique, latitude, above),
                            above > 1.0                 ? 0.05
                            : std::abs(latitude) < 80.0 ? 0.15
                                                        : 0.6);
            }
        }
    }
}

// A float of a column is millimetres off there.
TEST_F(CurvedReliefGlTest, ExactIsPreciseNearTheGroundOfAPlane) {
    EarthStage stage({.placement = terrain::PlacementKind::plane});
    stage.look({220.3, 201.7}, 0.3, {140.0, 40.0});
    for (const char* const technique : {"exact", "cone:n=1024,step=0"}) {
        expect_true(stage, technique, technique);
    }
}

TEST_F(CurvedReliefGlTest, ExactShowsTheTrueFirstHitAcrossTheAntimeridian) {
    EarthStage stage({.latitude = 30.0, .step = 0.004, .longitude = 179.5});
    stage.look({130.3, 240.7}, 2e3, {120.0, 10.0});
    expect_true(stage, "exact", "antimeridian");
}

TEST_F(CurvedReliefGlTest, ExactShowsTheTrueFirstHitOfExaggeratedGround) {
    EarthStage stage({.step = 0.004, .exaggeration = 5.0});
    stage.look({130.3, 240.7}, 2e3, {120.0, 10.0});
    expect_true(stage, "exact", "exaggerated");
}

// Floats of the eye's height are rounded by more than the surface is thick.
TEST_F(CurvedReliefGlTest, FlatGroundHasNoHolesFromHighAbove) {
    constexpr int side = EarthStage::side;
    for (const float relief : {0.0F, 0.002F, 1.0F}) {
        EarthStage stage({}, test::made_heights(side, side, [&](int col, int) {
                             return 100.0 + (col % 7 == 3 ? 1.0 : 0.0) * relief;
                         }));
        for (const double above : {30.0, 14e3, 2e5}) {
            stage.look({128.0, 128.0}, above, {129.0, 100.0});
            for (const char* const technique : {"exact", "cone", "relief"}) {
                const view::DrawnHits shown = hits(stage, technique);
                ASSERT_EQ(shown.stats.reliefs_as_triangles, 0) << above;
                EXPECT_LE(stage.errors(shown.hits).holes, 1U)
                    << technique << ", " << relief << " m, from " << above << " m";
            }
        }
    }
}

// Towers, 60 m high, whose walls are a sample wide.
Grid<float> towers() {
    constexpr int side = EarthStage::side;
    return test::made_heights(side, side, [](int col, int row) {
        return ((col / 5 + row / 7) % 3 == 0 ? 60.0 : 0.0) + 0.02 * col;
    });
}

// From below the border rays go on to the first front; their steps also run out close to walls.
TEST_F(CurvedReliefGlTest, TheFirstHitIsFoundFromBelowTheBorderAndWhereConesRunOutOfSteps) {
    for (const auto kind : {terrain::PlacementKind::plane, terrain::PlacementKind::ellipsoid}) {
        EarthStage stage({.step = 1e-5, .placement = kind}, towers());
        for (const glm::dvec2 from : {glm::dvec2(-13.0, 77.0), glm::dvec2(120.3, 201.7)}) {
            stage.look(from, 3.0, {128.0, 128.0});
            for (const char* const technique : {"exact", "cone:n=1024,step=0", "cone:n=4,step=0"}) {
                const view::DrawnHits shown = hits(stage, technique);
                ASSERT_EQ(shown.stats.reliefs_as_triangles, 0);
                EXPECT_LE(stage.errors(shown.hits).wrong, shown.hits.size() / 1000)
                    << technique << " from column " << from.x;
            }
        }
    }
}

// As wrong as over a plane.
TEST_F(CurvedReliefGlTest, EachTechniqueIsAsGoodAsOnAPlane) {
    EarthStage bent({.latitude = 45.0});
    EarthStage plane({.latitude = 45.0, .placement = terrain::PlacementKind::plane});
    const std::vector<std::string> techniques{"parallax",
                                              "parallax-limited",
                                              "parallax-iterated",
                                              "steep",
                                              "relief",
                                              "interval",
                                              "pom",
                                              "cone",
                                              "exact:fade=0.2..1",
                                              "relief:fade=0.2..1",
                                              "relief:steps=12..48"};
    std::map<std::string, double> wrong_on_plane;
    std::map<std::string, double> wrong;
    for (const double above : {100.0, 3e3}) {
        const glm::dvec2 from = above > 1e3 ? glm::dvec2(-13.0, 77.0) : glm::dvec2(120.3, 230.7);
        for (EarthStage* const stage : {&plane, &bent}) {
            stage->look(from, above, {140.0, 40.0});
            for (const std::string& technique : techniques) {
                const view::DrawnHits shown = hits(*stage, technique);
                ASSERT_EQ(shown.stats.reliefs_as_triangles, 0);
                const truth::GeometricErrors found = stage->errors(shown.hits);
                (stage == &bent ? wrong : wrong_on_plane)[technique] +=
                    static_cast<double>(found.wrong + found.holes);
            }
        }
    }
    for (const std::string& technique : techniques) {
        EXPECT_LE(wrong[technique], 1.1 * wrong_on_plane[technique] + 100.0) << technique;
        EXPECT_GE(wrong[technique], 0.8 * wrong_on_plane[technique] - 100.0) << technique;
    }
}

// Mountains of 3 km on flat ground, 27 km apart.
Grid<float> lone_mountains() {
    constexpr int side = EarthStage::side;
    return test::made_heights(side, side, [](int col, int row) {
        const double away = std::hypot(col % 60 - 30, row % 60 - 30); // samples
        return std::max(0.0, 3000.0 - 1000.0 * away);
    });
}

// At 4 degrees their shadows are 43 km long. There the ground has fallen by 144 m, which makes them
// two kilometres longer.
TEST_F(CurvedReliefGlTest, HardShadowIsTheShadowRayOfTheTruth) {
    for (const double altitude : {4.0, 30.0}) {
        for (const double latitude : {45.0, -60.0}) {
            EarthStage stage({.latitude = latitude, .step = 0.004, .turn = 20.0}, lone_mountains());
            stage.scene.add_light({297.0, altitude, glm::vec3(1.0F), glm::vec3(0.0F)});
            for (const double above : {3e3, 4e4}) {
                stage.look({120.3, 201.7}, above, {140.0, 40.0});
                const auto lit = test::lit_pixels(stage, curved_size);
                EXPECT_GT(test::count_of(lit, true) + test::count_of(lit, false), 3000U);
                for (const char* const technique :
                     {"exact:shadow=hard", "cone:n=1024,step=0,shadow=hard"}) {
                    EXPECT_LE(test::wrongly_lit(lit, picture(stage, technique)), 0.5)
                        << technique << " at " << latitude << ", sun at " << altitude << " degrees";
                }
            }
        }
    }
}

// Over 280 m the Earth is flat. By default every other picture is compared: each option from near
// and from far, with some of the searches.
TEST_F(CurvedReliefGlTest, OptionsShowOnSmallTerrainsWhatTheyShowOnAPlane) {
    EarthStage bent({.step = 1e-5}, towers());
    EarthStage plane({.step = 1e-5, .placement = terrain::PlacementKind::plane}, towers());
    for (EarthStage* const stage : {&plane, &bent}) {
        stage->scene.add_light({297.0, 25.0, glm::vec3(1.0F), glm::vec3(0.1F)});
    }
    bool from_far = true;
    for (const char* const technique :
         {"exact:edges=smooth,0.02", "relief:n=256,edges=smooth,0.02", "exact:shadow=hard",
          "cone:n=1024,step=0,shadow=hard", "relief:n=256,shadow=hard", "exact:shadow=soft,0.1",
          "relief:shadow=soft,0.1", "pom:shadow=hard", "exact:fade=0.2..1,shadow=hard",
          "relief:n=256,edges=smooth,0.02,shadow=hard"}) {
        from_far = !from_far;
        for (const double above : {3.0, 150.0}) {
            if (test::cases(0, 1) == 0 && (above > 3.0) != from_far) {
                continue;
            }
            for (EarthStage* const stage : {&plane, &bent}) {
                stage->look({120.3, 230.7}, above, {140.0, 40.0});
            }
            const Image on_plane = picture(plane, technique);
            const Image on_earth = picture(bent, technique);
            int different = 0;
            int without = 0;
            const std::string alone(technique, std::string(technique).find(':'));
            const Image plain = picture(bent, alone);
            for (std::size_t i = 0; i < on_earth.size(); ++i) {
                const auto differ = [&](const Image& other) {
                    return std::abs(brightness(on_earth.samples()[i]) -
                                    brightness(other.samples()[i])) > 12
                               ? 1
                               : 0;
                };
                different += differ(on_plane);
                without += differ(plain);
            }
            EXPECT_LE(different, curved_size.x * curved_size.y / 50)
                << technique << ", " << above << " m";
            EXPECT_GE(without, 2 * different) << technique << ", " << above << " m";
        }
    }
}

// Triangles stand in, and the frame says so: places are mapped one by one where no geoid is.
TEST_F(CurvedReliefGlTest, ViewsOverAGeoidThatBendRaysTooMuchShowTriangles) {
    for (const bool has_geoid : {false, true}) {
        terrain::Heightfield ground =
            test::geographic_heightfield(test::mountains(EarthStage::side), 89.9, 7.0, 0.01);
        if (has_geoid) {
            ground.georeference->geoid =
                geo::Geoid("made", Grid<float>(20, 20, 30.0F), {86.0, 6.0}, {0.25, 0.25});
        }
        EarthStage stage(std::move(ground), {.placement = terrain::PlacementKind::ellipsoid});
        stage.look({120.3, 201.7}, 3e4, {140.0, 40.0});
        const view::DrawnHits shown = hits(stage, "exact");
        EXPECT_EQ(shown.stats.reliefs_as_triangles, has_geoid ? 1 : 0);
        EXPECT_EQ(shown.stats.triangles > 500U, has_geoid);
    }
}

} // namespace
} // namespace reljef::render
