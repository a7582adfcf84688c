#include "engine/truth/detail_plane.h"

#include <cmath>
#include <string>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "engine/truth/image_error.h"
#include "tests/truth/techniques/tile_panel.h"
#include "tests/truth/techniques/two_ridges.h"

namespace reljef::truth {
namespace {

class TilePlaneGlTest : public test::GlTest {};

constexpr int panel_repeats = 3;

DetailPlane plane_of(const Panel& panel, const scene::Light& light,
                     std::optional<material::LayerKind> layers = std::nullopt) {
    const scene::SurfaceDetail& detail = panel.detail();
    return DetailPlane::create({.set = detail.set,
                                .layers = layers,
                                .side = static_cast<double>(plane_side),
                                .repeats = panel_repeats,
                                .scale = static_cast<double>(detail.scale),
                                .offset = static_cast<double>(detail.offset),
                                .light = light})
        .value();
}

// A colour that tells u from v, and one copy from none.
Image colored(int side) {
    Image colors(side, side);
    for (int row = 0; row < side; ++row) {
        for (int col = 0; col < side; ++col) {
            colors(col, row) = {static_cast<std::uint8_t>(60 + 120 * col / side),
                                static_cast<std::uint8_t>(200 - 120 * row / side), 90, 255};
        }
    }
    return colors;
}

Panel colored_panel(Grid<float> heights, float specular) {
    Panel panel(std::move(heights));
    material::ReliefMaterial set = *panel.detail().set;
    set.color = colored(8);
    set.specular = specular;
    panel.detail().set = std::make_shared<const material::ReliefMaterial>(std::move(set));
    return panel;
}

// The light leans against both axes: a mirrored normal would be as bright elsewhere.
TEST_F(TilePlaneGlTest, ExactWithItsShadowIsThePictureAndTheHitsOfTheTruth) {
    const scene::Light light{.azimuth = 205.0, .altitude = 33.0};
    for (const float offset : {-1.0F, -0.4F}) {
        Panel panel = colored_panel(wave_tile(32), 0.3F);
        panel.detail().offset = offset;
        panel.scene.add_light(light);
        const DetailPlane truth = plane_of(panel, light);
        const Picture picture =
            truth.draw(panel.scene.camera(), mesh_picture, {.rays_per_side = 3}).value();
        const Image shown = panel.picture("exact:shadow=hard");
        EXPECT_LT(root_mean_square_error(shown, picture.image).value(), 0.03);
        const HitBuffer hits = panel.hits("exact");
        const GeometricErrors errors =
            truth.errors(panel.scene.camera(), hits, picture.hits).value();
        EXPECT_LT(errors.wrong_percent, 0.1); // the square's outermost pixels
        EXPECT_LT(errors.reprojection.distribution->p99, 0.01);
        EXPECT_LT(errors.hit.distribution->p99, 0.01);
    }
}

TEST_F(TilePlaneGlTest, FourLayersAreWhatTheTruthShowsThem) {
    const scene::Light light{.azimuth = 205.0, .altitude = 33.0};
    Panel panel = colored_panel(wave_tile(32), 0.0F);
    panel.detail().offset = -0.5F;
    panel.scene.add_light(light);
    const DetailPlane truth = plane_of(panel, light, material::LayerKind::symmetric);
    const Picture picture =
        truth.draw(panel.scene.camera(), mesh_picture, {.rays_per_side = 3}).value();
    const Image shown = panel.picture("lattice:n=64,k=8,shadow=hard");
    EXPECT_LT(root_mean_square_error(shown, picture.image).value(), 0.04);
    const HitBuffer hits = panel.hits("lattice:n=64,k=8");
    const GeometricErrors errors = truth.errors(panel.scene.camera(), hits, picture.hits).value();
    EXPECT_LT(errors.wrong_percent, 0.3);
    EXPECT_LT(errors.reprojection.distribution->p95, 0.05);
}

// A level tile sunk by one height: what the flat technique shows lies as far off as the way of the
// ray from the square to the tile, seen from the eye.
TEST_F(TilePlaneGlTest, FlatPictureOfASunkenLevelTileIsOffByTheParallaxOfItsDepth) {
    Panel panel(Grid<float>(8, 8, 0.0F));
    const DetailPlane truth = plane_of(panel, {});
    const scene::Camera camera = panel.scene.camera();
    const Picture picture = truth.draw(camera, mesh_picture).value();
    const HitBuffer hits = panel.hits("texture");
    const GeometricErrors errors = truth.errors(camera, hits, picture.hits).value();
    const glm::ivec2 middle = mesh_picture / 2;
    const double deep = 0.1 * static_cast<double>(plane_side) / panel_repeats;
    const Ray ray = scene::view_ray(camera, mesh_picture, glm::dvec2(middle) + 0.5);
    const glm::dvec3 top = ray.at(-ray.origin.z / ray.direction.z);
    const glm::dvec3 below = top - glm::dvec3(0.0, 0.0, deep);
    const double expected =
        glm::length(scene::project(camera, mesh_picture, below).pixel - glm::dvec2(middle) - 0.5);
    EXPECT_NEAR(errors.reprojection.map(middle.x, middle.y), expected, 0.01);
    EXPECT_GT(expected, 3.0);
}

// A level square at half the tile's depth: where the relief's hit lies lower, the square is seen.
TEST_F(TilePlaneGlTest, WrittenDepthLetsAMeshCutTheReliefOfAnother) {
    Panel panel(wave_tile(32));
    const double deep = 0.1 * static_cast<double>(plane_side) / panel_repeats;
    panel.scene.add_mesh(scene::plane_mesh(glm::vec2(3.0F * plane_side)))
        .set_parent_from_local(glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 0.0, -0.5 * deep)));
    const Picture truth = plane_of(panel, {}).draw(panel.scene.camera(), mesh_picture).value();
    const auto differ = [&](const std::string& technique) {
        const HitBuffer hits = panel.hits(technique);
        int wrong = 0;
        int compared = 0;
        for (std::size_t i = 0; i < hits.size(); ++i) {
            const Hit& right = truth.hits.samples()[i];
            const bool is_clear = !right.is_sky() && std::abs(right.height - 0.5F) > 0.01F;
            const bool shows_square = hits.samples()[i].col == -1.0F;
            compared += is_clear ? 1 : 0;
            wrong += is_clear && shows_square != (right.height < 0.5F) ? 1 : 0;
        }
        EXPECT_GT(compared, 5000);
        return 100.0 * wrong / compared;
    };
    EXPECT_LT(differ("exact:depth=write"), 0.2); // the square's outermost pixels
    EXPECT_LT(differ("relief:n=64,k=8,depth=write"), 1.0);
    EXPECT_GT(differ("exact"), 20.0);
}

// A red ridge before a blue one on white ground: rays that pass the red one by less than E, and
// meet the ground, pass the blue one by a tenth of a metre less.
TEST_F(TilePlaneGlTest, SmoothEdgesOfAMeshBlendInWhatIsMissedByTheLeast) {
    const test::TwoRidges ridges(0.7F, 0.35F);
    Panel panel(ridges.heights, 1.0F);
    material::ReliefMaterial set = *panel.detail().set;
    set.color = ridges.colors;
    panel.detail().set = std::make_shared<const material::ReliefMaterial>(std::move(set));
    panel.detail().offset = 0.0F;
    panel.look({0.0, -6.0, 1.405}, {0.0, 0.0, 0.413});
    panel.camera->get<scene::Camera>()->projection = scene::ProjectionKind::orthographic;
    panel.camera->get<scene::Camera>()->view_height = 0.5;
    for (const std::string technique :
         {"exact:edges=smooth,0.25", "relief:n=256,edges=smooth,0.25"}) {
        const test::BlendedGround ground(panel.hits(technique), panel.picture(technique));
        EXPECT_EQ(ground.reddish, 0) << technique;
        EXPECT_GT(ground.bluish, 1000) << technique;
    }
}

TEST_F(TilePlaneGlTest, WhatFlatLightAndBackgroundLeaveIsKnown) {
    Panel panel(Grid<float>(8, 8, 1.0F));
    const scene::Light light{
        .azimuth = 180.0, .altitude = 90.0, .color = glm::vec3(0.5F), .ambient = glm::vec3(0.25F)};
    const Picture picture = plane_of(panel, light).draw(panel.scene.camera(), mesh_picture).value();
    const Rgba8 color = picture.image(mesh_picture.x / 2, mesh_picture.y / 2);
    const float albedo = linear_from_rgba8({128, 128, 128, 255}).r;
    EXPECT_NEAR(color.g, rgba8_from_linear(glm::vec3(0.75F * albedo)).g, 1);
    EXPECT_EQ(picture.image(0, 0).g, 0); // beside the square
    EXPECT_TRUE(picture.hits(0, 0).is_sky());
}

} // namespace
} // namespace reljef::truth
