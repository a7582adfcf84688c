// Each technique on its own claim, against the exact picture.
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "engine/core/statistics.h"
#include "engine/render/driver.h"
#include "engine/scene/motion/poses.h"
#include "engine/truth/draw.h"
#include "engine/truth/geometric_error.h"
#include "terrains/generators.h"
#include "tests/gl/gl_fixture.h"
#include "tests/render/made_scene.h"
#include "tests/scene/technique/terrain_techniques.h"
#include "tests/session/made_session.h"
#include "tests/support/release_only.h"

namespace reljef::truth {
namespace {

using scene::Pose;

constexpr glm::ivec2 picture_size{320, 240};
constexpr std::array every_pose{Pose::overview, Pose::oblique, Pose::low, Pose::grazing, Pose::map};

struct MadeSurface {
    std::string name;
    Grid<float> heights;
};

// Where a search goes wrong: nothing to find, one thing to find, steps, points, any size.
std::vector<MadeSurface> hard_surfaces() {
    std::vector<MadeSurface> surfaces;
    surfaces.push_back({"hills", test::hills(129, 97, 12.0)});
    surfaces.push_back({"noise", test::random_heights(65, 65, 0.0F, 8.0F, 3)});
    surfaces.push_back({"level", Grid<float>(40, 30, 7.0F)});
    Grid<float> spike(33, 33, 0.0F);
    spike(16, 16) = 20.0F;
    surfaces.push_back({"spike", std::move(spike)});
    surfaces.push_back({"checkerboard", test::made_heights(64, 64, [](int col, int row) {
                            return static_cast<double>((col + row) % 2);
                        })});
    surfaces.push_back({"cliffs", test::made_heights(90, 70, [](int col, int row) {
                            return (col / 7 + row / 9) % 3 == 0 ? 15.0 : 0.0;
                        })});
    surfaces.push_back(
        {"least", test::made_heights(2, 2, [](int col, int row) { return 0.3 * col * row; })});
    surfaces.push_back(
        {"strip", test::made_heights(2, 200, [](int, int row) { return 0.1 * (row % 13); })});
    return surfaces;
}

class TechniquesGlTest : public test::GlTest {
protected:
    struct Stage {
        scene::Scene scene;
        scene::Node* terrain = nullptr;
        scene::Node* camera = nullptr;
        explicit Stage(Grid<float> heights, glm::dvec2 spacing = {2.0, 2.0}) {
            terrain =
                &test::add_terrain(scene, test::plane_heightfield(std::move(heights), spacing), {},
                                   {.placement = terrain::PlacementKind::plane});
            camera = &scene.add_camera({});
            look(Pose::overview);
        }
        void look(Pose pose) {
            const auto& surface = test::surface_of(*terrain);
            *camera->get<scene::Camera>() =
                scene::pose_camera(pose, surface.bounds(), [&](double x, double y) {
                    return surface.height_at(x, y).value_or(0.0);
                });
        }
    };

    static HitBuffer shown(Stage& stage, const std::string& technique) {
        stage.terrain->get<scene::TerrainNode>()->material.technique =
            scene::parse_technique(technique).value();
        session::SceneRenderer driver = test::must(test::make_renderer(picture_size));
        return test::must(driver.draw_hits(stage.scene));
    }
    static GeometricErrors errors(Stage& stage, const std::string& technique) {
        const auto& surface = test::surface_of(*stage.terrain);
        const SurfaceView view{surface.heightfield().heights.view(), surface.placement(),
                               stage.terrain->world_from_local(), stage.scene.camera()};
        return geometric_errors(view, shown(stage, technique),
                                draw_hits(stage.scene, picture_size).value())
            .value();
    }
    // Root mean square of the distance to the true hit, texels.
    static double rms(Stage& stage, const std::string& technique) {
        return errors(stage, technique).hit.distribution.value().rms;
    }
};

TEST_F(TechniquesGlTest, ExactShowsTheTrueFirstHit) {
    for (const MadeSurface& surface : hard_surfaces()) {
        Stage stage(surface.heights);
        for (const Pose pose : every_pose) {
            stage.look(pose);
            if (pose == Pose::low && surface.name == "level") {
                continue; // the eye lies in the surface
            }
            const GeometricErrors found = errors(stage, "exact");
            EXPECT_LE(found.wrong_percent, 0.01) << surface.name << ' ' << to_string(pose);
        }
    }
}

TEST_F(TechniquesGlTest, ExactShowsTheTrueFirstHitOfTheBuiltInTerrains) {
    RELJEF_RELEASE_ONLY("other surfaces by the same lines");
    for (auto* const generate : {terrains::generate_natural, terrains::generate_urban}) {
        const terrain::Terrain made = test::must(generate({.size = 257}));
        Stage stage(made.heightfield.heights, made.heightfield.spacing);
        for (const Pose pose : every_pose) {
            stage.look(pose);
            EXPECT_LE(errors(stage, "exact").wrong_percent, 0.01) << to_string(pose);
        }
    }
}

TEST_F(TechniquesGlTest, ExactFollowsATurnedScaledAndMovedNode) {
    Stage stage(test::hills(129, 97, 12.0), {2.0, 3.0});
    stage.terrain->set_parent_from_local(
        glm::translate(glm::dmat4(1.0), glm::dvec3(5e5, 4e6, 100.0)) *
        glm::rotate(glm::dmat4(1.0), 0.7, glm::dvec3(0.1, 0.2, 1.0)) *
        glm::scale(glm::dmat4(1.0), glm::dvec3(1.5, 0.8, 2.0)));
    *stage.camera->get<scene::Camera>() =
        test::camera_at({5e5 - 150.0, 4e6 - 200.0, 260.0}, {5e5, 4e6, 100.0});
    EXPECT_LE(errors(stage, "exact").wrong_percent, 0.01);
}

TEST_F(TechniquesGlTest, ExactSeesFromInsideItsBox) {
    Stage stage(test::hills(129, 97, 12.0));
    for (const double heading : {0.0, 77.0, 200.0}) {
        *stage.camera->get<scene::Camera>() =
            scene::camera_from_angles({3.0, 5.0, 9.0}, heading, -8.0);
        EXPECT_LE(errors(stage, "exact").wrong_percent, 0.01) << heading;
    }
}

// Rays begin where the beam of their block of pixels may meet something: from anywhere, under any
// projection, no beam may pass what one of its rays meets.
TEST_F(TechniquesGlTest, BeamsPassNothingThatARayMeets) {
    std::mt19937 random(11);
    const auto between = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    for (const MadeSurface& surface : hard_surfaces()) {
        Stage stage(surface.heights);
        const Box bounds = test::surface_of(*stage.terrain).bounds();
        const double size = glm::length(bounds.high - bounds.low);
        for (int i = 0; i < 6; ++i) {
            const glm::dvec3 target(between(bounds.low.x, bounds.high.x),
                                    between(bounds.low.y, bounds.high.y), bounds.high.z);
            const glm::dvec3 away(between(-1.0, 1.0), between(-1.0, 1.0), between(0.05, 1.0));
            scene::Camera camera = test::camera_at(target + size * away, target);
            camera.vertical_fov = between(20.0, 140.0);
            if (i % 3 == 2) {
                camera.projection = scene::ProjectionKind::orthographic;
                camera.view_height = size * between(0.3, 2.0);
            }
            *stage.camera->get<scene::Camera>() = camera;
            EXPECT_LE(errors(stage, "exact").wrong_percent, 0.01) << surface.name << ' ' << i;
        }
    }
}

TEST_F(TechniquesGlTest, ExactIsFiniteWhateverTheExaggeration) {
    for (const double exaggeration : {1e-6, 1e-3, 1e3, 1e6}) {
        Stage stage(Grid<float>(2, 2, 0.0F));
        scene::Scene scene;
        test::add_terrain(
            scene, test::plane_heightfield(test::hills(65, 65, 12.0), {2.0, 2.0}), {},
            {.placement = terrain::PlacementKind::plane, .exaggeration = exaggeration})
            .get<scene::TerrainNode>()
            ->material.technique = scene::make_technique(scene::TechniqueId::exact);
        scene.add_camera(scene::pose_camera(Pose::overview, scene.root().world_bounds(),
                                            [](double, double) { return 0.0; }));
        session::SceneRenderer driver = test::must(test::make_renderer(picture_size));
        const HitBuffer hits = test::must(driver.draw_hits(scene));
        int terrain = 0;
        for (const Hit& hit : hits.samples()) {
            ASSERT_FALSE(std::isnan(hit.col + hit.row + hit.height + hit.depth));
            terrain += hit.is_sky() ? 0 : 1;
        }
        EXPECT_GT(terrain, 0) << exaggeration;
    }
}

// Also of rays that enter beneath the surface at the border.
TEST_F(TechniquesGlTest, RelaxedConesMissNothing) {
    RELJEF_RELEASE_ONLY("many tiles by the same few lines");
    for (const MadeSurface& surface : hard_surfaces()) {
        Stage stage(surface.heights);
        for (const Pose pose : {Pose::overview, Pose::grazing}) {
            stage.look(pose);
            EXPECT_LE(errors(stage, "cone:n=300,k=16,step=0").wrong_percent, 0.2)
                << surface.name << ' ' << to_string(pose);
        }
    }
}

// Plain cones end above the surface: the exact search goes on from there.
TEST_F(TechniquesGlTest, ConesThatRunOutOfStepsMissNothing) {
    Stage stage(test::hills(129, 97, 12.0));
    for (const char* const technique :
         {"cone:relaxed=0,n=300,step=0", "cone:relaxed=0,n=8,step=0", "cone:n=1,step=0"}) {
        EXPECT_LE(errors(stage, technique).wrong_percent, 0.2) << technique;
    }
}

TEST_F(TechniquesGlTest, ConesAsTheyAreByDefaultAreWrongInFewPixels) {
    Stage stage(test::hills(129, 97, 12.0));
    for (const Pose pose : {Pose::overview, Pose::low, Pose::grazing}) {
        stage.look(pose);
        EXPECT_LE(errors(stage, "cone").wrong_percent, 1.0) << to_string(pose);
    }
}

TEST_F(TechniquesGlTest, ConesShowTheSameHoweverHighTheHeightsAre) {
    Stage stage(test::hills(65, 65, 12.0), {2.0, 5.0});
    EXPECT_LE(errors(stage, "cone:n=300,step=0").wrong_percent, 0.2);
    Stage high(test::hills(65, 65, 1200.0), {2.0, 5.0});
    EXPECT_LE(errors(high, "cone:n=300,step=0").wrong_percent, 0.2);
}

// Between the first step below the surface and the true hit lies at most one step, so the error
// falls with the first power of their number; each halving takes half of it away.
TEST_F(TechniquesGlTest, StepsConvergeWithTheFirstPowerAndEachHalvingHalves) {
    Stage stage(test::hills(129, 97, 4.0));
    *stage.camera->get<scene::Camera>() = test::camera_at({0.0, -100.0, 220.0}, {0.0, 0.0, 0.0});
    const double steps = rms(stage, "steep:n=64") / rms(stage, "steep:n=16");
    EXPECT_NEAR(steps, 1.0 / 4.0, 0.05);
    const double halved = rms(stage, "relief:n=16,k=4") / rms(stage, "steep:n=16");
    EXPECT_NEAR(halved, 1.0 / 16.0, 0.01);
}

// On one bilinear patch, which has no edge, a chord's error falls with the square of the steps.
TEST_F(TechniquesGlTest, ChordsConvergeWithTheSecondPower) {
    Stage stage(test::made_heights(2, 2, [](int col, int row) { return 90.0 * col * row; }),
                {200.0, 200.0});
    *stage.camera->get<scene::Camera>() = test::camera_at({-100.0, -160.0, 260.0}, {0.0, 0.0, 0.0});
    const double chords = rms(stage, "interval:n=16,k=1") / rms(stage, "interval:n=4,k=1");
    EXPECT_GT(chords, 1.0 / 24.0);
    EXPECT_LT(chords, 1.0 / 10.0);
    EXPECT_LT(rms(stage, "interval:n=4,k=3"), 0.1 * rms(stage, "interval:n=4,k=1"));
}

TEST_F(TechniquesGlTest, MoreStepsAreNeverMoreWrong) {
    RELJEF_RELEASE_ONLY("each number of steps is the same shader");
    Stage stage(test::hills(129, 97, 12.0));
    for (const Pose pose : {Pose::overview, Pose::low}) {
        stage.look(pose);
        for (const std::string id : {"steep", "relief", "interval"}) {
            double before = 100.0;
            for (const int n : {8, 32, 128, 512}) {
                const double wrong = errors(stage, id + ":n=" + std::to_string(n)).wrong_percent;
                EXPECT_LE(wrong, before + 0.05) << id << ' ' << n << ' ' << to_string(pose);
                before = wrong;
            }
            EXPECT_LT(before, 2.0) << id;
        }
    }
}

TEST_F(TechniquesGlTest, PomTakesMoreStepsAlongTheGroundThanFromAbove) {
    Stage stage(test::hills(129, 97, 12.0));
    stage.look(Pose::map);
    const double few = rms(stage, "interval:n=8,k=1");
    EXPECT_NEAR(rms(stage, "pom:min=8,max=256"), few, 0.05 * few);
    stage.look(Pose::low);
    EXPECT_LT(errors(stage, "pom:min=8,max=256").wrong_percent,
              errors(stage, "pom:min=8,max=8").wrong_percent);
}

// Metres from where the ray meets the reference plane to the place that is shown, at the most.
double farthest_shift(const HitBuffer& hits, const scene::Camera& camera,
                      const scene::TerrainSurface& surface, double plane) {
    double farthest = 0.0;
    for (int y = 0; y < hits.rows(); ++y) {
        for (int x = 0; x < hits.cols(); ++x) {
            const Hit& hit = hits(x, y);
            if (hit.is_sky()) {
                continue;
            }
            const Ray ray = scene::view_ray(camera, picture_size, {x + 0.5, y + 0.5});
            const glm::dvec3 entry = ray.at((plane - ray.origin.z) / ray.direction.z);
            const glm::dvec3 shown =
                surface.placement().world_from_sample({hit.col, hit.row, hit.height});
            farthest = std::max(farthest, glm::distance(glm::dvec2(entry), glm::dvec2(shown)));
        }
    }
    return farthest;
}

TEST_F(TechniquesGlTest, LimitedParallaxNeverShiftsFurtherThanTheHeightAndPlainParallaxDoes) {
    Stage stage(test::hills(129, 97, 12.0));
    const auto& surface = test::surface_of(*stage.terrain);
    const terrain::MinMax total = surface.pyramid().total();
    const double range = static_cast<double>(total.high) - total.low;
    for (const double offset : {-0.5, -0.2, -1.0}) {
        for (const Pose pose : {Pose::overview, Pose::grazing}) {
            stage.look(pose);
            const std::string value = ":offset=" + std::to_string(offset);
            const double plane = total.low - offset * range;
            const double limit = range * std::max(-offset, 1.0 + offset);
            const auto& camera = stage.scene.camera();
            EXPECT_LE(
                farthest_shift(shown(stage, "parallax-limited" + value), camera, surface, plane),
                limit * 1.001);
            EXPECT_GT(farthest_shift(shown(stage, "parallax" + value), camera, surface, plane),
                      limit);
        }
    }
}

TEST_F(TechniquesGlTest, ParallaxIsBetterThanNoneSeenFromAboveAndBetterLookedAtAgain) {
    Stage stage(test::hills(129, 97, 4.0));
    *stage.camera->get<scene::Camera>() = test::camera_at({0.0, -100.0, 220.0}, {0.0, 0.0, 0.0});
    const double flat = rms(stage, "texture");
    const double once = rms(stage, "parallax");
    const double again = rms(stage, "parallax-iterated");
    EXPECT_LT(once, 0.5 * flat);
    EXPECT_LT(again, once);
}

TEST_F(TechniquesGlTest, AFlatSurfaceIsExactForAllThatLookForIt) {
    Stage stage(Grid<float>(40, 30, 7.0F));
    for (const scene::TechniqueInfo& info : scene::terrain_techniques()) {
        if (scene::geometry_of(info.id) == scene::Geometry::box &&
            !info.name.starts_with("parallax") && info.id != scene::TechniqueId::steep) {
            EXPECT_LE(errors(stage, std::string(info.name)).wrong_percent, 0.3) << info.name;
        }
    }
}

TEST_F(TechniquesGlTest, ThoseOfMeshesAreRefusedForATerrainWithWhatWorks) {
    for (const scene::TechniqueInfo& info : scene::technique_catalogue()) {
        if (scene::draws_terrain(info.id)) {
            continue;
        }
        Stage stage(test::hills(33, 33, 4.0));
        stage.terrain->get<scene::TerrainNode>()->material.technique =
            scene::make_technique(info.id);
        session::SceneRenderer driver = test::must(test::make_renderer(picture_size));
        const auto drawn = driver.draw(stage.scene);
        ASSERT_FALSE(drawn) << info.name;
        EXPECT_NE(drawn.error().message.find("a mesh with a detail texture was expected"),
                  std::string::npos);
        const char* const works = scene::searches_layers(info.id)               ? "exact"
                                  : info.id == scene::TechniqueId::displacement ? "polygons"
                                                                                : "texture";
        EXPECT_NE(drawn.error().message.find(works), std::string::npos);
    }
}

TEST_F(TechniquesGlTest, OverTheCurvedEarthPrewarpIsRefusedByName) {
    scene::Scene scene;
    auto& terrain = test::add_terrain(
        scene, test::geographic_heightfield(test::hills(61, 51, 600.0), 46.0, 7.0, 0.004));
    terrain.get<scene::TerrainNode>()->material.technique =
        test::must(scene::parse_technique("prewarp"));
    scene.add_camera(test::camera_at({0.0, -25000.0, 9000.0}, {0.0, 0.0, 0.0}));
    session::SceneRenderer driver = test::must(test::make_renderer(picture_size));
    const auto drawn = driver.draw(scene);
    ASSERT_FALSE(drawn);
    EXPECT_NE(drawn.error().message.find("placement ellipsoid"), std::string::npos)
        << drawn.error().message;
}

} // namespace
} // namespace reljef::truth
