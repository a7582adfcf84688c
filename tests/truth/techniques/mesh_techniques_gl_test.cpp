// Each technique on a mesh with a tile of detail, against the exact relief of that tile.
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "engine/render/driver.h"
#include "engine/render/shaders/frame_block.h"
#include "engine/truth/geometric_error.h"
#include "tests/session/made_session.h"
#include "tests/support/release_only.h"
#include "tests/truth/techniques/tile_panel.h"

namespace reljef::truth {
namespace {

class MeshTechniquesGlTest : public test::GlTest {};

TEST_F(MeshTechniquesGlTest, ExactShowsTheTrueFirstHitBeyondEveryBorder) {
    RELJEF_RELEASE_ONLY("the same shader on the tiles of other tests");
    for (const MadeTile& tile : hard_tiles()) {
        for (const WrapMode border : {WrapMode::wrap, WrapMode::clamp, WrapMode::discard}) {
            Panel panel(tile.heights);
            panel.detail().border = border;
            const TileErrors found = tile_errors(panel, panel.hits("exact"));
            EXPECT_GT(found.pixels, 5000);
            EXPECT_LE(found.wrong_percent(), 0.01)
                << tile.name << " border " << static_cast<int>(border);
            EXPECT_LE(found.depth, 1e-3) << tile.name;
        }
    }
}

TEST_F(MeshTechniquesGlTest, ExactIsRightFromAboveLowAndWhereverThePlaneLies) {
    for (const float offset : {-1.0F, -0.5F, 0.0F}) {
        Panel panel(noise_tile(16, 16, 8));
        panel.detail().offset = offset;
        for (const glm::dvec3 eye : {glm::dvec3(0.2, -0.1, 6.0), glm::dvec3(0.4, -4.0, 2.0),
                                     glm::dvec3(-3.0, -4.0, 0.7), glm::dvec3(0.1, -3.5, 0.3)}) {
            panel.look(eye, {0.1, 0.2, 0.0});
            const TileErrors found = tile_errors(panel, panel.hits("exact"));
            EXPECT_LE(found.wrong_percent(), 0.01) << offset << " from " << eye.z;
        }
    }
}

TEST_F(MeshTechniquesGlTest, ExactFollowsATurnedScaledAndMovedNode) {
    Panel panel(wave_tile(32));
    const glm::dvec3 far(5e5, 4e6, 100.0);
    panel.node->set_parent_from_local(glm::translate(glm::dmat4(1.0), far) *
                                      glm::rotate(glm::dmat4(1.0), 0.7, glm::dvec3(0.1, 0.2, 1.0)) *
                                      glm::scale(glm::dmat4(1.0), glm::dvec3(1.5, 0.8, 2.0)));
    panel.look(far + glm::dvec3(1.0, -5.0, 6.0), far);
    const TileErrors found = tile_errors(panel, panel.hits("exact"));
    EXPECT_LE(found.wrong_percent(), 0.01);
    EXPECT_LE(found.depth, 1e-3);
}

TEST_F(MeshTechniquesGlTest, ExactSeesAMapAsItSeesAView) {
    Panel panel(noise_tile(16, 16, 9));
    scene::Camera& camera = *panel.camera->get<scene::Camera>();
    camera = test::camera_at({-2.0, -5.0, 6.0}, {0.0, 0.0, 0.0});
    camera.projection = scene::ProjectionKind::orthographic;
    camera.view_height = 4.0;
    EXPECT_LE(tile_errors(panel, panel.hits("exact")).wrong_percent(), 0.01);
}

// As on terrains: the first power of the steps' number, and half with each halving.
TEST_F(MeshTechniquesGlTest, StepsConvergeAndHalvingsHalve) {
    Panel panel(wave_tile(64));
    panel.look({0.0, -1.0, 5.0}, {0.0, 0.0, 0.0});
    const auto rms = [&](const std::string& technique) {
        return tile_errors(panel, panel.hits(technique)).rms();
    };
    EXPECT_NEAR(rms("steep:n=64") / rms("steep:n=16"), 0.25, 0.05);
    EXPECT_NEAR(rms("relief:n=16,k=4") / rms("steep:n=16"), 1.0 / 16.0, 0.015);
    EXPECT_LT(rms("interval:n=16,k=2"), 0.1 * rms("steep:n=16"));
    EXPECT_LT(rms("interval:n=64,k=2"), rms("interval:n=16,k=2"));
    EXPECT_LT(rms("parallax-iterated"), rms("texture"));
}

TEST_F(MeshTechniquesGlTest, MoreStepsAreNeverMoreWrongOnHardTiles) {
    Panel panel(noise_tile(16, 16, 10));
    for (const std::string id : {"relief", "interval"}) {
        double before = 100.0;
        for (const int n : {8, 32, 128, 512}) {
            const double wrong =
                tile_errors(panel, panel.hits(id + ":n=" + std::to_string(n))).wrong_percent();
            EXPECT_LE(wrong, before + 0.05) << id << ' ' << n;
            before = wrong;
        }
        EXPECT_LT(before, 1.0) << id;
    }
}

TEST_F(MeshTechniquesGlTest, LimitedParallaxNeverShiftsFurtherThanTheReliefIsDeepAndPlainDoes) {
    for (const float offset : {-1.0F, -0.7F}) {
        Panel panel(noise_tile(16, 16, 11));
        panel.detail().offset = offset;
        panel.look({0.1, -3.5, 0.4}, {0.1, 0.2, 0.0});
        const HitBuffer flat = panel.hits("texture");
        const HitBuffer limited = panel.hits("parallax-limited");
        const HitBuffer plain = panel.hits("parallax");
        double farthest = 0.0;
        double farthest_plain = 0.0;
        for (std::size_t i = 0; i < flat.size(); ++i) {
            const auto off = [&](const HitBuffer& shown) {
                const Hit& from = flat.samples()[i];
                const Hit& to = shown.samples()[i];
                return from.is_sky() ? 0.0
                                     : apart({from.col, from.row}, {to.col, to.row}, panel.texels,
                                             WrapMode::wrap);
            };
            farthest = std::max(farthest, off(limited));
            farthest_plain = std::max(farthest_plain, off(plain));
        }
        // s |b| tile widths of 16 texels; and a float's rounding of coordinates up to 48.
        EXPECT_LE(farthest, 0.1 * -static_cast<double>(offset) * 16.0 + 1e-4);
        EXPECT_GT(farthest, 0.2);
        EXPECT_GT(farthest_plain, 0.1 * 16.0);
    }
}

// A ramp that rises to the east: one normal all over, known from its slope.
TEST_F(MeshTechniquesGlTest, ANormalMapLightsAsTheGradientOfTheHeights) {
    Grid<float> ramp(64, 64);
    for (int row = 0; row < 64; ++row) {
        for (int col = 0; col < 64; ++col) {
            ramp(col, row) = static_cast<float>(col) / 64.0F;
        }
    }
    for (const float scale : {0.1F, 0.4F}) {
        Panel panel(ramp, 1.0F);
        panel.detail().scale = scale; // another than the normal map was made for, too
        panel.look({0.0, 0.0, 4.0}, {0.0, 0.001, 0.0});
        const scene::Light light{.azimuth = 270.0, .altitude = 40.0};
        panel.scene.add_light(light);
        const glm::dvec3 normal = glm::normalize(glm::dvec3(-scale, 0.0, 1.0));
        const double sun = glm::dot(normal, scene::to_light(light));
        const glm::dvec3 expected =
            glm::dvec3(linear_from_rgba8({128, 128, 128, 255})) *
            (glm::dvec3(light.color) * sun + glm::dvec3(light.ambient) * (0.5 + 0.5 * normal.z));
        const Rgba8 color = rgba8_from_linear(glm::vec3(expected));
        for (const char* technique : {"normal", "bump", "relief", "exact"}) {
            const Rgba8 shown = panel.picture(technique)(mesh_picture.x / 2, mesh_picture.y / 2);
            EXPECT_NEAR(shown.r, color.r, 2) << technique << ' ' << scale;
            EXPECT_NEAR(shown.g, color.g, 2) << technique << ' ' << scale;
            EXPECT_NEAR(shown.b, color.b, 2) << technique << ' ' << scale;
        }
        // To the first order in the slope, emboss says the same.
        const double upright = std::sin(std::acos(-1.0) * 40.0 / 180.0);
        const double embossed = upright + scale * std::cos(std::acos(-1.0) * 40.0 / 180.0);
        const glm::dvec3 first_order =
            glm::dvec3(linear_from_rgba8({128, 128, 128, 255})) *
            (glm::dvec3(light.color) * embossed + glm::dvec3(light.ambient));
        const Rgba8 shown = panel.picture("emboss")(mesh_picture.x / 2, mesh_picture.y / 2);
        EXPECT_NEAR(shown.r, rgba8_from_linear(glm::vec3(first_order)).r, 2) << scale;
    }
}

// How much the brightness of what is shown differs over the middle of a picture.
double contrast(const Image& picture) {
    double sum = 0.0;
    double squares = 0.0;
    int count = 0;
    for (int y = mesh_picture.y / 2 - 15; y < mesh_picture.y / 2 + 15; ++y) {
        for (int x = mesh_picture.x / 2 - 15; x < mesh_picture.x / 2 + 15; ++x) {
            const double bright = linear_from_rgba8(picture(x, y)).g;
            sum += bright;
            squares += bright * bright;
            ++count;
        }
    }
    return std::sqrt(std::max(squares / count - sum * sum / count / count, 0.0)) / (sum / count);
}

// Steep edges, seen from so far that many texels share a pixel.
TEST_F(MeshTechniquesGlTest, BumpFromAfarIsAsStrongAsANormalMap) {
    Grid<float> steps(128, 128, 0.0F);
    for (int row = 0; row < 128; ++row) {
        for (int col = 0; col < 128; ++col) {
            steps(col, row) = (col / 11 + row / 17) % 3 == 0 ? 1.0F : 0.0F;
        }
    }
    Panel panel(steps, 3.0F);
    panel.scene.add_light({.azimuth = 240.0, .altitude = 35.0});
    for (const double far : {3.0, 9.0, 18.0}) {
        panel.look({0.0, -0.3 * far, far}, {0.0, 0.0, 0.0});
        const double normal = contrast(panel.picture("normal"));
        EXPECT_NEAR(contrast(panel.picture("bump")) / normal, 1.0, 0.3) << far;
    }
}

TEST_F(MeshTechniquesGlTest, EmbossHasNoSpecularAndTheOthersDo) {
    const auto differs = [](const std::string& technique) {
        Image before;
        int different = 0;
        for (const float specular : {0.0F, 1.0F}) {
            Panel panel(wave_tile(32));
            panel.detail().set = made_set(wave_tile(32), 0.1F, specular);
            panel.scene.add_light({.azimuth = 0.0, .altitude = 37.0}); // mirrored into the eye
            const Image picture = panel.picture(technique);
            for (std::size_t i = 0; i < before.size(); ++i) {
                different += before.samples()[i] == picture.samples()[i] ? 0 : 1;
            }
            before = picture;
        }
        return different;
    };
    EXPECT_EQ(differs("emboss"), 0);
    EXPECT_EQ(differs("texture"), 0);
    for (const char* technique : {"normal", "bump", "parallax", "relief"}) {
        EXPECT_GT(differs(technique), 100) << technique;
    }
}

TEST_F(MeshTechniquesGlTest, DisplacedVerticesLieOnTheSurface) {
    Panel panel(wave_tile(32));
    panel.look({0.1, -0.3, 3.0}, {0.1, 0.1, 0.0}); // no border in sight
    const TileErrors coarse = tile_errors(panel, panel.hits("displacement:texels=8"));
    const TileErrors fine = tile_errors(panel, panel.hits("displacement:texels=1"));
    EXPECT_LT(fine.wrong_percent(), 0.5);
    EXPECT_LT(fine.rms(), 0.1 * tile_errors(panel, panel.hits("texture")).rms());
    EXPECT_LT(fine.rms(), 0.5 * coarse.rms());
}

// From near, from far at a hair's breadth above the ground, and from beside.
void expect_sound_pictures(Panel& panel, session::SceneRenderer& driver, std::string_view name) {
    for (const glm::dvec3 eye :
         {glm::dvec3(2.0, -3.0, 2.5), glm::dvec3(0.0, -60.0, 0.01), glm::dvec3(0.2, -1.5, 0.001)}) {
        panel.look(eye, {0.0, 0.0, 0.0});
        test::must(driver.draw(panel.scene));
        int shown = 0;
        const HitBuffer hits = test::must(driver.draw_hits(panel.scene));
        for (const Hit& hit : hits.samples()) {
            ASSERT_FALSE(std::isnan(hit.col + hit.row + hit.height)) << name;
            ASSERT_TRUE(hit.height >= 0.0F && hit.height <= 1.0F) << name;
            shown += hit.is_sky() ? 0 : 1;
        }
        EXPECT_TRUE(shown > 0 || eye.z < 0.1) << name;
    }
}

TEST_F(MeshTechniquesGlTest, EveryTechniqueDrawsEveryShapeFromFarNearAndGrazing) {
    const std::vector<scene::Mesh> shapes{
        scene::plane_mesh({2.0F, 2.0F}), scene::box_mesh({1.0F, 2.0F, 1.5F}),
        scene::sphere_mesh(1.0F, 24), scene::torus_mesh(1.0F, 0.4F, 24),
        scene::cylinder_mesh(1.0F, 2.0F, 24)};
    session::SceneRenderer driver = test::must(test::make_renderer({48, 36}));
    for (const scene::Mesh& shape : shapes) {
        Panel panel(noise_tile(16, 16, 12), 2.0F);
        panel.node->get<scene::MeshNode>()->mesh = std::make_shared<const scene::Mesh>(shape);
        panel.scene.add_light();
        for (const scene::TechniqueInfo& info : scene::technique_catalogue()) {
            if (!scene::draws_any_mesh(info.id)) {
                continue;
            }
            panel.material().technique = scene::make_technique(info.id);
            expect_sound_pictures(panel, driver, info.name);
        }
    }
}

TEST_F(MeshTechniquesGlTest, WhatNoMeshCanShowIsRefusedWithTheReason) {
    Panel panel(wave_tile(8));
    panel.node->get<scene::MeshNode>()->mesh =
        std::make_shared<const scene::Mesh>(scene::box_mesh(glm::vec3(1.0F)));
    panel.material().technique = scene::make_technique(scene::TechniqueId::prewarp);
    session::SceneRenderer driver = test::must(test::make_renderer(mesh_picture));
    const auto drawn = driver.draw(panel.scene);
    ASSERT_FALSE(drawn);
    EXPECT_NE(drawn.error().message.find("not flat found, one plane was expected; relief draws"),
              std::string::npos)
        << drawn.error().message;
}

TEST_F(MeshTechniquesGlTest, SilhouettesAreRefusedBesideWhatTheyDoNotGoWith) {
    const Panel panel(wave_tile(8));
    const auto refusal = [&](const std::string& options) {
        const auto technique = scene::parse_technique("exact:silhouettes=true" + options).value();
        const auto good = scene::check_technique(technique, *panel.node->get<scene::MeshNode>());
        return good ? std::string() : good.error().message;
    };
    EXPECT_EQ(refusal(",shadow=soft,0.3,border=clamp,depth=write"), "");
    EXPECT_EQ(
        refusal(",fade=0.2..1"),
        "technique exact: silhouettes=true found beside fade, which was not expected: heights "
        "that change with the view have no outline");
    EXPECT_NE(refusal(",edges=smooth").find("beside edges"), std::string::npos);
    EXPECT_NE(refusal(",sides=two").find("a hull is seen from outside"), std::string::npos);
}

// Forward, the relief lands where rays find it, but for what lies within a sample of a silhouette.
TEST_F(MeshTechniquesGlTest, PrewarpShowsOnAFlatMeshWhatRaysFind) {
    for (const float offset : {-1.0F, -0.4F}) {
        Panel panel(wave_tile(64));
        panel.detail().offset = offset;
        for (const glm::dvec3 eye : {glm::dvec3(0.2, -0.5, 6.0), glm::dvec3(0.3, -4.0, 3.0)}) {
            panel.look(eye, {0.1, 0.0, 0.0});
            const TileErrors warped = tile_errors(panel, panel.hits("prewarp"));
            const TileErrors flat = tile_errors(panel, panel.hits("texture"));
            EXPECT_GT(warped.compared, 5000);
            EXPECT_LT(warped.rms(), 0.3 * flat.rms()) << offset << " from " << eye.z;
            EXPECT_LT(warped.wrong_percent(), 0.3 * flat.wrong_percent() + 1.0);
        }
    }
}

TEST_F(MeshTechniquesGlTest, TheTechniquesBorderComesBeforeTheMaterials) {
    Panel panel(noise_tile(16, 16, 13));
    for (const auto& [word, border] :
         {std::pair{"wrap", WrapMode::wrap}, std::pair{"clamp", WrapMode::clamp},
          std::pair{"discard", WrapMode::discard}}) {
        const HitBuffer hits = panel.hits(std::string("exact:border=") + word);
        panel.detail().border = border;
        EXPECT_LE(tile_errors(panel, hits).wrong_percent(), 0.01) << word;
        panel.detail().border = WrapMode::wrap;
    }
}

// What parallax leads to off a tile that is bounded is nothing, as for those that follow the ray.
TEST_F(MeshTechniquesGlTest, ParallaxShowsNothingBeyondABoundedTile) {
    Panel panel(noise_tile(16, 16, 13));
    const auto shown = [&](const std::string& technique) {
        const HitBuffer hits = panel.hits(technique);
        return std::count_if(hits.samples().begin(), hits.samples().end(), shows_terrain);
    };
    for (const std::string technique : {"parallax", "parallax-limited", "parallax-iterated"}) {
        EXPECT_LT(shown(technique + ":border=discard"), shown(technique + ":border=clamp") - 5)
            << technique;
    }
}

// Whether the sun reaches what the pixel of a picture without any other light shows; nothing where
// the surface nearly lies along its rays.
std::optional<bool> truly_lit(const Panel& panel, const ReliefPlane& relief, glm::dvec3 to_light,
                              glm::ivec2 pixel) {
    const Ray ray = scene::view_ray(panel.scene.camera(), mesh_picture, glm::dvec2(pixel) + 0.5);
    const auto hit = relief.first_hit(ray);
    if (!hit) {
        return std::nullopt;
    }
    const scene::SurfaceDetail& detail = panel.detail();
    const auto height = [&](glm::dvec2 off) {
        return scene::tile_height(*detail.set, hit->texture_coordinate + off, detail.border);
    };
    const double step = 0.5 / panel.texels.x;
    const glm::dvec2 slope =
        static_cast<double>(detail.scale) / (2.0 * step) *
        glm::dvec2(height({step, 0.0}) - height({-step, 0.0}),
                   height({0.0, -step}) - height({0.0, step})); // v grows against y
    const double facing = glm::dot(glm::normalize(glm::dvec3(-slope, 1.0)), to_light);
    if (facing < 0.1) {
        return facing < -0.1 ? std::optional(false) : std::nullopt;
    }
    const glm::dvec3 place = ray.at(hit->t) + glm::dvec3(0.0, 0.0, 1e-4);
    return !relief.first_hit({place, to_light}).has_value();
}

TEST_F(MeshTechniquesGlTest, AHardShadowIsThatOfTheTruthsRay) {
    Panel panel(wave_tile(32), 1.0F);
    panel.detail().scale = 0.5F;
    panel.look({0.2, -2.0, 6.5}, {0.1, 0.0, 0.0});
    const scene::Light light{
        .azimuth = 250.0, .altitude = 25.0, .color = glm::vec3(1.0F), .ambient = glm::vec3(0.0F)};
    panel.scene.add_light(light);
    const Image picture = panel.picture("exact:shadow=hard");
    const auto relief = ReliefPlane::create(panel.detail().set->heights.view(),
                                            {plane_side, 0.5, -1.0, Border::wrap})
                            .value();
    int compared = 0;
    int wrong = 0;
    int dark = 0;
    for (int y = 45; y < mesh_picture.y - 45; ++y) {
        for (int x = 65; x < mesh_picture.x - 65; ++x) {
            const auto lit = truly_lit(panel, relief, scene::to_light(light), {x, y});
            const Rgba8 shown = picture(x, y);
            compared += lit ? 1 : 0;
            wrong += lit && *lit != (shown.r + shown.g + shown.b > 3) ? 1 : 0;
            dark += lit && !*lit ? 1 : 0;
        }
    }
    EXPECT_GT(compared, 6000);
    EXPECT_GT(dark, 800);
    EXPECT_LE(wrong, compared / 200);
}

TEST_F(MeshTechniquesGlTest, OptionsDoOnMeshesWhatTheySay) {
    Panel panel(wave_tile(32));
    const TileErrors plain = tile_errors(panel, panel.hits("steep:n=8"));
    const TileErrors stepped = tile_errors(panel, panel.hits("steep:n=8,steps=64..64"));
    EXPECT_LT(stepped.rms(), 0.2 * plain.rms());
    // A fade to nothing is the flat surface.
    const HitBuffer faded = panel.hits("exact:fade=0..0");
    const HitBuffer flat = panel.hits("texture");
    for (std::size_t i = 0; i < flat.size(); ++i) {
        const Hit& one = faded.samples()[i];
        const Hit& other = flat.samples()[i];
        if (!one.is_sky() && !other.is_sky()) {
            ASSERT_LT(
                apart({one.col, one.row}, {other.col, other.row}, panel.texels, WrapMode::wrap),
                0.05);
        }
    }
    for (const char* options : {"edges=smooth,0.05", "shadow=soft,0.2", "depth=write"}) {
        panel.scene.add_light();
        panel.picture(std::string("relief:") + options);
    }
}

// What has no tile is drawn as before, and what draws it is not there.
TEST_F(MeshTechniquesGlTest, AMeshOfOneColourNeitherLooksForASurfaceNorUploadsATile) {
    Panel panel(wave_tile(32));
    panel.material().technique = scene::make_technique(scene::TechniqueId::exact);
    session::SceneRenderer driver = test::must(test::make_renderer(mesh_picture));
    const auto with_tile = test::must(driver.draw(panel.scene));
    panel.detail().set = nullptr;
    session::SceneRenderer other = test::must(test::make_renderer(mesh_picture));
    const auto without = test::must(other.draw(panel.scene));
    EXPECT_EQ(without.uploads, with_tile.uploads - 6)
        << "colour, heights, normals, pyramid; the blocks of technique and tile";
    EXPECT_EQ(without.upload_bytes, sizeof(float) * (4U * 6U + 6U) + sizeof(render::FrameBlock));
}

} // namespace
} // namespace reljef::truth
