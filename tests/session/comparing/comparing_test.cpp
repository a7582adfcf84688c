#include <algorithm>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/scene/graph/scene.h"
#include "engine/session/comparing/compared_picture.h"
#include "engine/session/comparing/error_figures.h"
#include "engine/session/comparing/error_map.h"
#include "engine/session/comparing/scene_truth.h"
#include "engine/session/comparing/wipe.h"
#include "tests/app/made_hill.h"

namespace reljef::session {
namespace {

using testing::HasSubstr;

constexpr Rgba8 red{200, 0, 0, 255};
constexpr Rgba8 blue{0, 0, 200, 255};

TEST(Wipe, ShowsTheLeftPictureUpToTheLineAndTheRightOneFromThere) {
    const Image left(100, 3, red);
    const Image right(100, 3, blue);
    const Image both = wiped(left, right, 0.3);
    EXPECT_EQ(both(0, 0), red);
    EXPECT_EQ(both(27, 2), red);
    EXPECT_EQ(both(32, 2), blue);
    EXPECT_EQ(both(99, 0), blue);
    EXPECT_NE(both(29, 1), red);  // the line
    EXPECT_NE(both(30, 1), blue); // the line
}

TEST(Wipe, IsOnePictureAloneAtTheEdges) {
    const Image left(10, 2, red);
    const Image right(10, 2, blue);
    EXPECT_EQ(wiped(left, right, 1.0), left);
    EXPECT_EQ(wiped(left, right, 0.0), right);
    EXPECT_EQ(wiped(left, right, 7.0), left);
    EXPECT_EQ(wipe_column(-1.0, 10), 0);
    EXPECT_NO_FATAL_FAILURE(wiped(Image(1, 1, red), Image(1, 1, blue), 0.5));
}

TEST(ErrorMap, ColoursGrowLighterWithTheErrorAndEndAtTheirBounds) {
    const auto lightness = [](Rgba8 color) { return color.r + color.g; };
    int before = -1;
    for (const double pixels : {0.1, 0.3, 1.0, 3.0, 10.0}) {
        EXPECT_GT(lightness(error_color(pixels)), before) << pixels;
        before = lightness(error_color(pixels));
    }
    EXPECT_EQ(error_color(0.0), error_color(min_mapped_error));
    EXPECT_EQ(error_color(1e9), error_color(max_mapped_error));
}

// Errors of a picture of a row of pixels.
truth::GeometricErrors made_errors(const std::vector<float>& pixels,
                                   const std::vector<truth::Verdict>& verdicts) {
    const int cols = static_cast<int>(pixels.size());
    truth::GeometricErrors errors;
    errors.reprojection.map = Grid<float>(cols, 1);
    errors.hit.map = Grid<float>(cols, 1, 0.0F);
    errors.verdicts = Grid<truth::Verdict>(cols, 1);
    for (int i = 0; i < cols; ++i) {
        const auto index = static_cast<std::size_t>(i);
        errors.reprojection.map(i, 0) = pixels[index];
        errors.verdicts(i, 0) = verdicts[index];
    }
    return errors;
}

TEST(ErrorMap, TellsHolesAndErrorsWithoutBoundFromOthers) {
    using truth::Verdict;
    const float none = std::numeric_limits<float>::quiet_NaN();
    auto errors =
        made_errors({none, none, 0.01F, 5.0F, std::numeric_limits<float>::infinity(), 0.01F},
                    {Verdict::no_terrain, Verdict::hole, Verdict::right, Verdict::right,
                     Verdict::wrong, Verdict::wrong});
    const Image map = error_map(errors, Image(6, 1, Rgba8{100, 100, 100, 255}));
    EXPECT_EQ(map(5, 0), wrong_color);
    EXPECT_EQ(map(0, 0), map(2, 0)); // grey
    EXPECT_EQ(map(0, 0).r, map(0, 0).b);
    EXPECT_EQ(map(1, 0), hole_color);
    EXPECT_GT(map(3, 0).r, map(3, 0).b);
    EXPECT_EQ(map(4, 0), unbounded_color);
}

TEST(ErrorFigures, AreThoseOfTheDistribution) {
    std::vector<float> pixels;
    for (int i = 0; i <= 1000; ++i) {
        pixels.push_back(static_cast<float>(i) / 100.0F);
    }
    auto errors = made_errors(pixels, std::vector<truth::Verdict>(1001, truth::Verdict::right));
    errors.reprojection.distribution = truth::Distribution{1001, 5.0, 9.5, 9.9, 10.0, 5.8};
    errors.wrong_percent = 12.0;
    errors.holes = 1001 / 2;
    const Image grey(1001, 1, Rgba8{100, 100, 100, 255});
    const auto figures = error_figures(errors, grey, grey);
    ASSERT_TRUE(figures) << figures.error().message;
    ASSERT_TRUE(figures->pixels);
    EXPECT_NEAR(figures->pixels->p999, 9.99, 1e-6); // of 0, 0.01, …, 10
    EXPECT_EQ(figures->pixels->max, 10.0);
    EXPECT_NEAR(figures->hole_percent, 50.0, 0.1);
    EXPECT_FALSE(figures->psnr);
    EXPECT_FALSE(figures->ssim); // one row is smaller than its window
    EXPECT_THAT(to_string(*figures), HasSubstr("99.9 % within 10 px"));
    EXPECT_THAT(to_string(*figures), HasSubstr("identical pictures"));
}

TEST(ErrorFigures, RefusePicturesOfDifferentSizes) {
    const auto errors = made_errors({1.0F}, {truth::Verdict::right});
    EXPECT_FALSE(error_figures(errors, Image(1, 1), Image(2, 1)));
}

TEST(CompareRequest, IsTheTruthItsErrorsOrATechnique) {
    EXPECT_FALSE(parse_compare_request("truth")->technique);
    EXPECT_TRUE(parse_compare_request("errors")->errors);
    EXPECT_EQ(parse_compare_request("texture")->technique->id(), scene::TechniqueId::texture);
    const auto refused = parse_compare_request("truht");
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message, HasSubstr("truth, errors or a technique"));
}

struct SceneTruthTest : testing::Test {
    TerrainScene scene = app::hill_scene();
    SceneTruth truth = SceneTruth::create(scene.scene).value();
    scene::Camera camera = scene.scene.camera();
    static constexpr glm::ivec2 size{40, 30};
};

TEST_F(SceneTruthTest, IsTheExactPictureAndHasNoErrors) {
    const auto expected = truth::draw(scene.scene, size);
    const auto drawn = truth.draw(camera, size);
    ASSERT_TRUE(expected && drawn);
    EXPECT_EQ(drawn->image, expected->image);
    const auto errors = truth.errors(camera, drawn->hits, drawn->hits);
    ASSERT_TRUE(errors) << errors.error().message;
    EXPECT_EQ(errors->wrong, 0U);
    // Hits are rounded to floats, and their remainders, too.
    EXPECT_LT(errors->reprojection.distribution->max, 1e-4);
}

TEST_F(SceneTruthTest, StaysThatOfTheSceneAsItWas) {
    const auto before = truth.draw(camera, size);
    EXPECT_TRUE(truth.is_of(scene.scene));
    scene.light->get<scene::Light>()->azimuth += 90.0;
    EXPECT_FALSE(truth.is_of(scene.scene));
    scene.terrain->set_visible(false);
    const auto after = truth.draw(camera, size);
    ASSERT_TRUE(before && after);
    EXPECT_EQ(before->image, after->image);
}

TEST_F(SceneTruthTest, DoesNotDependOnTheTechnique) {
    scene.materials().front()->technique = scene::Technique{scene::Texture{}};
    EXPECT_TRUE(truth.is_of(scene.scene));
}

TEST_F(SceneTruthTest, HasTheShadowsOfRaysWhereTheTechniqueCastsHardOnes) {
    scene.scene
        .add_mesh(scene::box_mesh(glm::vec3(static_cast<float>(scene.bounds.size().x) / 10.0F)))
        .set_position({glm::dvec2(scene.bounds.center()), scene.bounds.high.z});
    truth = SceneTruth::create(scene.scene).value();
    scene.materials().front()->technique = scene::parse_technique("exact:shadow=hard").value();
    EXPECT_FALSE(truth.is_of(scene.scene));
    SceneTruth by_rays = SceneTruth::create(scene.scene).value();
    const auto drawn = by_rays.draw(camera, size);
    const auto moved = SceneTruth(std::move(by_rays)).draw(camera, size);
    const auto expected = truth::draw(scene.scene, size, {.shadow = truth::SunShadow::ray});
    const auto swept = truth.draw(camera, size);
    ASSERT_TRUE(drawn && moved && expected && swept);
    EXPECT_EQ(drawn->image, expected->image);
    EXPECT_EQ(moved->image, expected->image);
    EXPECT_NE(swept->image, expected->image);
}

TEST_F(SceneTruthTest, HasPointLightsAndEndsWhereTheyMove) {
    const auto dark = truth.draw(camera, size);
    const glm::dvec3 place(glm::dvec2(scene.bounds.center()), scene.bounds.high.z + 20.0);
    scene::Node& lamp = scene.scene.add_point_light({.intensity = 900.0F, .range = 200.0F}, place);
    EXPECT_FALSE(truth.is_of(scene.scene));
    SceneTruth lit = SceneTruth::create(scene.scene).value();
    EXPECT_TRUE(lit.is_of(scene.scene));
    const auto drawn = lit.draw(camera, size);
    const auto expected = truth::draw(scene.scene, size);
    ASSERT_TRUE(dark && drawn && expected);
    EXPECT_EQ(drawn->image, expected->image);
    EXPECT_NE(drawn->image, dark->image);
    lamp.set_position(place + glm::dvec3(1.0, 0.0, 0.0));
    EXPECT_FALSE(lit.is_of(scene.scene));
}

TEST_F(SceneTruthTest, HasObjectsAndEndsWhereTheyMove) {
    scene::Node& box = scene.scene.add_mesh(scene::box_mesh(glm::vec3(1.0F)));
    EXPECT_FALSE(truth.is_of(scene.scene));
    const SceneTruth with_box = SceneTruth::create(scene.scene).value();
    EXPECT_TRUE(with_box.is_of(scene.scene));
    box.set_position({0.0, 0.0, 1.0});
    EXPECT_FALSE(with_box.is_of(scene.scene));
}

TEST_F(SceneTruthTest, EndsWhenStopped) {
    std::stop_source stop;
    stop.request_stop();
    EXPECT_FALSE(truth.draw(camera, size, {.parallel = {1, stop.get_token(), {}}}));
}

TEST(SceneTruth, RefusesScenesOfModels) {
    auto relief = std::make_shared<material::ReliefMaterial>();
    relief->heights = Grid<float>(2, 2, 0.5F);
    scene::Material material;
    material.detail.set = relief;
    scene::Scene scene;
    scene.add_mesh(scene::plane_mesh(glm::vec2(1.0F)), material);
    const auto truth = SceneTruth::create(scene);
    ASSERT_FALSE(truth);
    EXPECT_THAT(truth.error().message, HasSubstr("models found"));
}

// Frames by exact rays, so that they have no errors.
TEST_F(SceneTruthTest, AFrameIsComparedWithTheTruthOrAnotherTechnique) {
    Log log;
    TruthFrames frames(size, 1, log);
    const auto left = frames.draw(scene.scene, {});
    ASSERT_TRUE(left);
    CompareRequest request{.errors = true, .technique = {}, .share = 0.0};
    const auto map = compared_picture(scene, frames, *left, request, {}, log);
    ASSERT_TRUE(map) << map.error().message;
    EXPECT_EQ(map->figures.size(), 1U);
    EXPECT_EQ(map->figures.front().wrong_percent, 0.0);
    EXPECT_EQ(map->picture(5, 5).r, map->picture(5, 5).g); // grey: no error
    request = {.errors = false, .technique = scene::Technique{scene::Texture{}}, .share = 1.0};
    const auto both = compared_picture(scene, frames, *left, request, {}, log);
    ASSERT_TRUE(both) << both.error().message;
    EXPECT_EQ(both->picture, *left);
    EXPECT_EQ(both->figures.size(), 2U);
    EXPECT_NE(scene.materials().front()->technique.id(), scene::TechniqueId::texture);
}

TEST_F(SceneTruthTest, ComparingSaysHowFarItIsAndStops) {
    Log log;
    TruthFrames frames(size, 1, log);
    const auto left = frames.draw(scene.scene, {});
    ASSERT_TRUE(left);
    const CompareRequest request{.errors = true, .technique = {}};
    std::vector<double> parts;
    ParallelOptions parallel{
        .threads = 1, .stop = {}, .progress = [&](double part) { parts.push_back(part); }};
    ASSERT_TRUE(compared_picture(scene, frames, *left, request, parallel, log));
    EXPECT_TRUE(std::is_sorted(parts.begin(), parts.end()));
    EXPECT_GT(parts.size(), 4U);
    std::stop_source stop;
    parallel.stop = stop.get_token();
    parallel.progress = [&](double /*part*/) { stop.request_stop(); };
    EXPECT_FALSE(compared_picture(scene, frames, *left, request, parallel, log));
}

TEST_F(SceneTruthTest, ATechniqueThatCannotDrawTheSceneIsRefused) {
    Log log;
    TruthFrames frames(size, 1, log);
    const auto left = frames.draw(scene.scene, {});
    const CompareRequest request{.errors = false,
                                 .technique = scene::make_technique(scene::TechniqueId::bump)};
    const auto refused = compared_picture(scene, frames, *left, request, {}, log);
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message, HasSubstr("bump"));
}

} // namespace
} // namespace reljef::session
