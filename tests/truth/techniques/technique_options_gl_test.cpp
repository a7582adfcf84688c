// Each option on its own claim, against the exact picture.
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "engine/truth/image_error.h"
#include "engine/truth/shading.h"
#include "tests/support/release_only.h"
#include "tests/truth/techniques/relief_stage.h"
#include "tests/truth/techniques/two_ridges.h"

namespace reljef::truth {
namespace {

using scene::Pose;
using test::ReliefStage;

class TechniqueOptionsGlTest : public test::GlTest {};

DrawOptions rays_a_side(int rays) {
    DrawOptions options;
    options.rays_per_side = rays;
    return options;
}

// Only the sun: black is shadow.
scene::Light sun_alone(double azimuth, double altitude) {
    return {azimuth, altitude, glm::vec3(1.0F), glm::vec3(0.0F)};
}

// Blocks with streets between them, as of a town.
Grid<float> blocks() {
    return test::made_heights(121, 121, [](int col, int row) {
        const bool street = col % 20 < 6 || row % 24 < 8;
        return street ? 0.0 : 10.0 + (col / 20 * 7 + row / 24 * 5) % 4 * 5.0;
    });
}

// All rays at one angle from the vertical, degrees.
scene::Camera slanted(double angle) {
    const double a = glm::radians(angle);
    scene::Camera camera =
        test::camera_at(500.0 * glm::dvec3(0.0, -std::sin(a), std::cos(a)), glm::dvec3(0.0));
    camera.projection = scene::ProjectionKind::orthographic;
    camera.view_height = 180.0;
    return camera;
}

TEST_F(TechniqueOptionsGlTest, StepsAreAsManyAsTheAngleOfViewAsksFor) {
    ReliefStage stage(test::hills(129, 97, 12.0));
    for (const double angle : {0.0, 35.0, 60.0, 80.0}) {
        stage.look(slanted(angle));
        const double n = 5.0 + (40.0 - 5.0) * (1.0 - std::cos(glm::radians(angle)));
        // Rounding may put a whole number on either side: the angles give none.
        for (const char* form : {"relief:n={},k=3{}", "steep:n={}{}", "interval:n={},k=1{}"}) {
            const HitBuffer equal = stage.hits(
                fmt::format(fmt::runtime(form), static_cast<int>(std::ceil(n - 1e-6)), ""));
            const HitBuffer by_angle =
                stage.hits(fmt::format(fmt::runtime(form), 1, ",steps=5..40"));
            int different = 0;
            for (std::size_t i = 0; i < equal.size(); ++i) {
                different += equal.samples()[i].col != by_angle.samples()[i].col ? 1 : 0;
            }
            EXPECT_EQ(different, 0) << form << ' ' << angle;
        }
    }
}

// The surface with heights so much smaller about the middle of their range.
Grid<float> shrunk(const Grid<float>& heights, double share) {
    const auto [low, high] =
        std::minmax_element(heights.samples().begin(), heights.samples().end());
    const double middle = 0.5 * (static_cast<double>(*low) + *high);
    return test::made_heights(heights.cols(), heights.rows(), [&](int col, int row) {
        return middle + share * (heights(col, row) - middle);
    });
}

TEST_F(TechniqueOptionsGlTest, FadedHeightsAreThoseOfTheFormula) {
    const Grid<float> heights = test::hills(129, 97, 12.0);
    ReliefStage stage(heights);
    struct Case {
        double angle, low, high, power;
    };
    for (const Case& c : {Case{60.0, 0.5, 0.5, 1.0}, Case{60.0, 0.2, 0.8, 1.0},
                          Case{75.0, 0.0, 1.0, 3.0}, Case{30.0, 0.1, 0.4, 2.0}}) {
        const double cosine = std::cos(glm::radians(c.angle));
        const double share = c.low + (c.high - c.low) * (1.0 - std::pow(1.0 - cosine, c.power));
        ReliefStage faded(shrunk(heights, share));
        stage.look(slanted(c.angle));
        faded.look(slanted(c.angle));
        const auto option = fmt::format(":fade={}..{},{}", c.low, c.high, c.power);
        EXPECT_LE(test::elsewhere_percent(stage.hits("exact" + option), faded.true_hits()), 0.1)
            << option;
        EXPECT_LE(
            test::elsewhere_percent(stage.hits("relief" + option + ",n=256"), faded.true_hits()),
            1.0)
            << option;
    }
}

TEST_F(TechniqueOptionsGlTest, FadingByNothingIsNotFading) {
    ReliefStage stage(test::hills(129, 97, 12.0));
    for (const Pose pose : {Pose::overview, Pose::low, Pose::grazing, Pose::map}) {
        stage.look(pose);
        EXPECT_LE(test::elsewhere_percent(stage.hits("exact:fade=1..1"), stage.true_hits()), 0.05);
        EXPECT_LE(test::elsewhere_percent(stage.hits("parallax:fade=1..1"), stage.hits("parallax")),
                  0.05);
    }
}

// Share of pixels where one picture is black and the other is not, percent.
double differently_lit(const Image& a, const Image& b) {
    int different = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        different += (a.samples()[i].r == 0) != (b.samples()[i].r == 0) ? 1 : 0;
    }
    return 100.0 * different / static_cast<double>(a.size());
}

// What the rays of the truth say of a pixel: whether its place is lit, and how much if it is.
class SunOfTheTruth {
public:
    explicit SunOfTheTruth(ReliefStage& stage)
        : surface_(stage.surface()), caster_(SceneCaster::create(stage.scene()).value()),
          sun_(*stage.scene().sun()), irradiance_(surface_, {sun_, glm::dmat3(1.0)}) {}

    // Nothing where a place has as good as no light even if nothing hides the sun.
    [[nodiscard]] std::optional<bool> sees(const Hit& hit) const {
        const glm::dvec2 place(hit.col, hit.row);
        if (hit.is_sky() || irradiance_.parts_at(place).sun.r < 0.05F) {
            return std::nullopt;
        }
        SceneHit there;
        there.surface.sample = glm::dvec3(
            place, terrain::bilinear_height(surface_.heightfield().heights.view(), place));
        return sees_sun(caster_, there, scene::to_light(sun_));
    }

private:
    const scene::TerrainSurface& surface_;
    SceneCaster caster_;
    scene::Light sun_;
    scene::TerrainIrradiance irradiance_;
};

// Of the pixels that the sun may light, those that are black though it does or not though it does
// not, percent.
double wrongly_lit(ReliefStage& stage, const std::string& technique) {
    const SunOfTheTruth truth(stage);
    const HitBuffer hits = stage.true_hits();
    const Image shown = stage.image(technique);
    int all = 0;
    int wrong = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (const auto sees = truth.sees(hits.samples()[i])) {
            ++all;
            wrong += (shown.samples()[i].r != 0) != *sees ? 1 : 0;
        }
    }
    EXPECT_GT(all, 10000);
    return 100.0 * wrong / all;
}

TEST_F(TechniqueOptionsGlTest, HardShadowIsTheShadowRayOfTheTruth) {
    RELJEF_RELEASE_ONLY("the rays of the truth have tests of their own");
    const std::array surfaces{test::hills(129, 97, 12.0), blocks()};
    for (const Grid<float>& heights : surfaces) {
        for (const double altitude : {8.0, 35.0}) {
            ReliefStage stage(heights,
                              {.spacing = {2.0, 2.0}, .light = sun_alone(297.0, altitude)});
            for (const Pose pose : {Pose::overview, Pose::low}) {
                stage.look(pose);
                EXPECT_LE(wrongly_lit(stage, "exact:shadow=hard"), 0.5)
                    << altitude << ' ' << to_string(pose);
                EXPECT_LE(wrongly_lit(stage, "relief:n=256,k=8,shadow=hard"), 1.0)
                    << altitude << ' ' << to_string(pose);
            }
        }
    }
}

// A place in the lee of a wall, one before it, one on top, and one that is turned away.
TEST_F(TechniqueOptionsGlTest, TheTruthsRayToTheSunIsRightAtAWall) {
    const Grid<float> wall =
        test::made_heights(41, 41, [](int col, int) { return col == 20 ? 10.0 : 0.0; });
    ReliefStage stage(wall, {.spacing = {1.0, 1.0}, .light = sun_alone(90.0, 45.0)});
    const SceneCaster caster = SceneCaster::create(stage.scene()).value();
    const auto lit = [&](double col) {
        SceneHit hit;
        hit.surface.sample = {col, 17.3, terrain::bilinear_height(wall.view(), {col, 17.3})};
        return sees_sun(caster, hit, scene::to_light(*stage.scene().sun()));
    };
    EXPECT_TRUE(lit(30.0));
    EXPECT_TRUE(lit(20.4)) << "the side that is turned to the sun";
    EXPECT_TRUE(lit(20.0)) << "the edge";
    EXPECT_FALSE(lit(19.6)) << "the side that is turned away";
    EXPECT_FALSE(lit(12.0));
    EXPECT_FALSE(lit(10.01)) << "the shadow of 10 m at 45 degrees";
    EXPECT_TRUE(lit(9.99));
}

// The deeper a ray may go, the more light is left; of the hard shadow's light none is taken.
TEST_F(TechniqueOptionsGlTest, SoftShadowIsMonotoneInItsDepthAndHardAtItsEnd) {
    ReliefStage stage(test::hills(129, 97, 12.0),
                      {.spacing = {2.0, 2.0}, .light = sun_alone(297.0, 12.0)});
    for (const std::string technique : {"relief:n=32", "exact:", "pom:"}) {
        const auto soft = [&](double depth) {
            return stage.image(fmt::format("{}{}shadow=soft,{}", technique,
                                           technique.ends_with(':') ? "" : ",", depth));
        };
        Image before = soft(0.001);
        int lighter = 0;
        for (const double depth : {0.01, 0.05, 0.2, 0.5, 1.0}) {
            Image now = soft(depth);
            for (std::size_t i = 0; i < now.size(); ++i) {
                ASSERT_GE(now.samples()[i].r, before.samples()[i].r) << technique << depth;
                lighter += now.samples()[i].r > before.samples()[i].r ? 1 : 0;
            }
            before = std::move(now);
        }
        EXPECT_GT(lighter, 1000) << technique;
    }
    EXPECT_LE(
        differently_lit(stage.image("exact:shadow=soft,0.001"), stage.image("exact:shadow=hard")),
        1.0);
}

// Straight down nothing is in shadow: light in two parts is the same light.
TEST_F(TechniqueOptionsGlTest, LightInPartsIsTheWholeWhereNothingIsHidden) {
    ReliefStage stage(test::hills(129, 97, 12.0),
                      {.spacing = {2.0, 2.0}, .light = scene::Light{.altitude = 90.0}});
    const Image whole = stage.image("exact");
    for (const char* shadow : {"hard", "soft,0.1"}) {
        const Image parts = stage.image(fmt::format("exact:shadow={}", shadow));
        int farthest = 0;
        for (std::size_t i = 0; i < whole.size(); ++i) {
            farthest = std::max(farthest, std::abs(whole.samples()[i].r - parts.samples()[i].r));
        }
        EXPECT_LE(farthest, 2) << shadow; // each part is rounded by itself
    }
}

TEST_F(TechniqueOptionsGlTest, ASunBelowTheHorizonLightsNothing) {
    ReliefStage stage(test::hills(129, 97, 12.0), {.light = sun_alone(90.0, -5.0)});
    for (const char* technique : {"exact:shadow=hard", "relief:shadow=soft"}) {
        const Image image = stage.image(technique);
        EXPECT_TRUE(std::all_of(image.samples().begin(), image.samples().end(), [](Rgba8 pixel) {
            return pixel.r == 0;
        })) << technique;
    }
}

// Behind an edge lies what is darker or lighter: the pixels along it are a mix of both. A pixel
// here is about a hundredth of the range of heights.
TEST_F(TechniqueOptionsGlTest, SmoothEdgesComeNearerToTheMeanOverThePixel) {
    RELJEF_RELEASE_ONLY("the mean is many pictures by the same lines");
    const Grid<float> heights = blocks();
    Image color(heights.cols(), heights.rows());
    for (std::size_t i = 0; i < color.size(); ++i) {
        const bool is_roof = heights.samples()[i] > 0.0F;
        color.samples()[i] = is_roof ? Rgba8{230, 180, 150, 255} : Rgba8{40, 50, 60, 255};
    }
    ReliefStage stage(heights, {.spacing = {2.0, 2.0}, .light = {}, .color = color});
    for (const double height : {60.0, 35.0}) {
        stage.look(test::camera_at({-35.0, -65.0, height}, {0.0, -5.0, 15.0}));
        const Image truth = stage.true_image(rays_a_side(4));
        const auto error = [&](const std::string& technique) {
            return root_mean_square_error(stage.image(technique), truth).value();
        };
        for (const std::string technique : {"exact:depth=none", "relief:n=256"}) {
            EXPECT_LT(error(technique + ",edges=smooth,0.004"), 0.98 * error(technique))
                << technique << ' ' << height;
        }
    }
}

// Two ridges, red before blue, on white ground. A ray that passes the red one by 0.5 to 0.75 m
// passes the blue one by half a metre less.
TEST_F(TechniqueOptionsGlTest, SmoothEdgesBlendInWhatIsMissedByTheLeast) {
    const test::TwoRidges ridges(3.0F, 1.5F);
    ReliefStage stage(ridges.heights,
                      {.spacing = {1.0, 1.0}, .size = {320, 240}, .color = ridges.colors});
    scene::Camera camera = test::camera_at({0.0, -30.0, 5.9}, {0.0, 0.0, 2.9});
    camera.projection = scene::ProjectionKind::orthographic;
    camera.view_height = 3.0;
    stage.look(camera);
    for (const std::string technique :
         {"exact:edges=smooth,0.25", "relief:n=512,edges=smooth,0.25"}) {
        const test::BlendedGround ground(stage.hits(technique), stage.image(technique));
        EXPECT_EQ(ground.reddish, 0) << technique;
        EXPECT_GT(ground.bluish, 1000) << technique;
    }
}

// A box half sunk into the ground: where it is nearer than the ground, and only there, it is seen.
TEST_F(TechniqueOptionsGlTest, MeshesCutTheReliefUnlessItWritesNoDepth) {
    ReliefStage stage(test::hills(129, 97, 12.0));
    for (const glm::dvec3 place : {glm::dvec3(0.0, -20.0, 2.0), glm::dvec3(40.0, 10.0, 0.0)}) {
        stage.scene()
            .add_mesh(scene::box_mesh({24.0F, 18.0F, 26.0F}))
            .set_parent_from_local(glm::rotate(glm::translate(glm::dmat4(1.0), place), 0.5,
                                               glm::dvec3(0.2, 0.1, 1.0)));
    }
    for (const Pose pose : {Pose::overview, Pose::low, Pose::map}) {
        stage.look(pose);
        const HitBuffer polygons = stage.hits("polygons");
        const auto differ = [&](const char* technique) {
            const HitBuffer shown = stage.hits(technique);
            int wrong = 0;
            for (std::size_t i = 0; i < shown.size(); ++i) {
                const bool is_mesh =
                    shown.samples()[i].col == -1.0F && !shown.samples()[i].is_sky();
                const bool is_there =
                    polygons.samples()[i].col == -1.0F && !polygons.samples()[i].is_sky();
                wrong += is_mesh != is_there ? 1 : 0;
            }
            return 100.0 * wrong / static_cast<double>(shown.size());
        };
        EXPECT_LE(differ("exact"), 0.05) << to_string(pose);
        EXPECT_LE(differ("relief:n=128"), 0.2) << to_string(pose);
        EXPECT_EQ(differ("exact:depth=write"), differ("exact")) << to_string(pose);
        EXPECT_GT(differ("exact:depth=none"), 0.1) << to_string(pose);
    }
}

} // namespace
} // namespace reljef::truth
