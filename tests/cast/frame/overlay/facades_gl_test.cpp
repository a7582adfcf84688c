#include <array>

#include <gtest/gtest.h>

#include "tests/cast/frame/compared_pictures.h"
#include "tests/cast/frame/overlay_stage.h"
#include "tests/gl/gl_fixture.h"
#include "tests/terrain/made_house.h"

namespace reljef::cast {
namespace {

class FacadesGlTest : public test::GlTest {};

// A house, seen from an azimuth around it.
struct HouseStage : OverlayStage {
    HouseStage() : OverlayStage(Grid<float>(2, 2, 0.0F)) {
        set(test::made_house());
        node().grain = 0.0F;
    }
    void set(terrain::Terrain house) {
        node().surface =
            std::make_shared<const scene::TerrainSurface>(test::must(scene::TerrainSurface::create(
                std::make_shared<const terrain::Terrain>(std::move(house)))));
    }
    void look_from_azimuth(double degrees) {
        const double azimuth = glm::radians(degrees);
        scene::Camera camera;
        camera.eye = {22.0 * std::sin(azimuth), 22.0 * std::cos(azimuth), 9.0};
        camera.target = {0.0, 0.0, 5.0};
        look(camera);
    }
};

int changed_pixels(const Image& a, const Image& b) {
    int changed = 0;
    for (std::size_t i = 0; i < a.samples().size(); ++i) {
        changed += a.samples()[i] != b.samples()[i] ? 1 : 0;
    }
    return changed;
}

// Triangles of corners and of the borders of walls lie beside the cells.
TEST_F(FacadesGlTest, RaysAndShadersShowTheSame) {
    HouseStage stage;
    for (const auto& [technique, share] : {std::pair{"exact", 0.002}, {"polygons", 0.05}}) {
        for (const double azimuth : {20.0, 110.0, 200.0, 290.0}) {
            stage.look_from_azimuth(azimuth);
            stage.node().material.technique = {scene::Exact{}};
            const Image rays = stage.drawn();
            const Image shaders = stage.drawn_by_opengl(technique);
            EXPECT_LE(test::share_of_others(rays, shaders, 6), share)
                << technique << ' ' << azimuth;
        }
    }
}

TEST_F(FacadesGlTest, LieOnWallsOnlyAndChangeNoHit) {
    HouseStage stage;
    for (const double azimuth : {20.0, 110.0, 200.0, 290.0}) {
        stage.look_from_azimuth(azimuth);
        const Image with = stage.drawn();
        const HitBuffer hits = stage.hits();
        stage.node().hides_overlay = true;
        const Image without = stage.drawn();
        stage.node().hides_overlay = false;
        int on_walls = 0;
        int shown = 0;
        for (int row = 0; row < overlay_picture.y; ++row) {
            for (int col = 0; col < overlay_picture.x; ++col) {
                const bool is_shown = with(col, row) != without(col, row);
                const double height = hits(col, row).is_sky() ? 0.0 : hits(col, row).height;
                ASSERT_FALSE(is_shown && hits(col, row).is_sky());
                ASSERT_FALSE(is_shown && (height < 0.0 || height > test::house_eaves))
                    << col << ' ' << row << ' ' << height;
                const bool is_wall = height > 0.1 && height < test::house_eaves - 0.1;
                on_walls += is_wall ? 1 : 0;
                shown += is_shown && is_wall ? 1 : 0;
            }
        }
        EXPECT_GT(on_walls, 5000);
        EXPECT_GT(shown, 0.97 * on_walls) << azimuth;
    }
}

// A wall's light does not change from sample to sample, as that of its slopes does.
TEST_F(FacadesGlTest, PlasterIsEven) {
    HouseStage stage;
    terrain::Terrain house = test::made_house();
    for (terrain::Facade& wall : house.facades.walls) {
        wall.foot = -100.0; // of windows, none: all lies above the eaves
        wall.eaves = 100.0 + 1e-3;
        wall.rise = 100.0;
    }
    stage.set(std::move(house));
    stage.sun().azimuth = 200.0;
    stage.look_from_azimuth(200.0);
    const Image drawn = stage.drawn();
    const HitBuffer hits = stage.hits();
    std::array<int, 2> range{255, 0};
    for (int row = 0; row < overlay_picture.y; ++row) {
        for (int col = 100; col < 200; ++col) {
            const double height = hits(col, row).is_sky() ? 0.0 : hits(col, row).height;
            if (height > 3.0 && height < test::house_eaves - 1.0) {
                range[0] = std::min(range[0], static_cast<int>(drawn(col, row).g));
                range[1] = std::max(range[1], static_cast<int>(drawn(col, row).g));
            }
        }
    }
    ASSERT_LT(range[0], range[1] + 1);
    EXPECT_LE(range[1] - range[0], 3);
}

TEST_F(FacadesGlTest, EveryInstructionSetPaintsThem) {
    HouseStage stage;
    stage.look_from_azimuth(200.0);
    const Image first = stage.drawn();
    for (const SimdTarget& target : simd_targets()) {
        const Image other = stage.drawn({.size = overlay_picture, .target = target});
        EXPECT_LE(test::share_of_others(first, other, 2), 0.002) << target.name;
    }
}

TEST_F(FacadesGlTest, FollowTheSun) {
    HouseStage stage;
    stage.look_from_azimuth(200.0);
    stage.sun().azimuth = 200.0;
    Driver driver = test::must(Driver::create({.size = overlay_picture}));
    const auto drawn = [&] {
        test::must(driver.draw(view::select(stage.scene, overlay_picture)));
        return driver.read_color();
    };
    const Image front = drawn();
    stage.sun().azimuth = 20.0;
    const Image behind = drawn();
    EXPECT_GT(changed_pixels(front, behind), 5000);
    EXPECT_EQ(behind, stage.drawn()) << "a driver that saw another sun before";
}

// By the law of point lights, with the normal of the wall: it is even, its cells are not.
TEST_F(FacadesGlTest, PointLightsLightThem) {
    HouseStage stage;
    stage.sun().color = glm::vec3(0.0F);
    stage.sun().ambient = glm::vec3(0.0F);
    stage.look_from_azimuth(200.0);
    const Image dark = stage.drawn();
    EXPECT_EQ(dark(overlay_picture.x / 2, overlay_picture.y / 2), (Rgba8{0, 0, 0, 255}));
    const double azimuth = glm::radians(200.0);
    stage.scene.add_point_light({.color = {1.0F, 0.8F, 0.6F}, .intensity = 60.0F, .range = 60.0F},
                                {14.0 * std::sin(azimuth), 14.0 * std::cos(azimuth), 6.0});
    const Image rays = stage.drawn();
    EXPECT_GT(changed_pixels(rays, dark), 20'000);
    for (const auto& [technique, share] : {std::pair{"exact", 0.002}, {"polygons", 0.05}}) {
        EXPECT_LE(test::share_of_others(rays, stage.drawn_by_opengl(technique), 6), share)
            << technique;
    }
}

TEST_F(FacadesGlTest, ObjectsShadeThem) {
    HouseStage stage;
    stage.sun().azimuth = 200.0;
    stage.sun().altitude = 30.0;
    scene::Technique technique{scene::Exact{}};
    technique.options.shadow = scene::Shadow{.depth = 0.0};
    stage.node().material.technique = technique;
    stage.look_from_azimuth(160.0);
    const Image sunny = stage.drawn();
    const HitBuffer hits = stage.hits();
    const glm::dvec3 to_sun = scene::to_light(stage.sun());
    stage.scene.add_mesh(scene::box_mesh({30.0F, 30.0F, 30.0F}), {})
        .set_position(45.0 * to_sun + glm::dvec3(0.0, 0.0, 6.0));
    const Image shaded = stage.drawn();
    int walls = 0;
    int darker = 0;
    for (int row = 0; row < overlay_picture.y; ++row) {
        for (int col = 0; col < overlay_picture.x; ++col) {
            const double height = hits(col, row).is_sky() ? 0.0 : hits(col, row).height;
            if (height > 1.0 && height < test::house_eaves - 1.0 && sunny(col, row).r > 150) {
                ++walls;
                darker += shaded(col, row).r + 30 < sunny(col, row).r ? 1 : 0;
            }
        }
    }
    EXPECT_GT(walls, 2000);
    EXPECT_GT(darker, 0.99 * walls);
}

// Higher houses have higher storeys: as many ledges, as sharp.
TEST_F(FacadesGlTest, GrowWithTheExaggeration) {
    HouseStage stage;
    const auto with = [&](double factor) {
        stage.node().surface = std::make_shared<const scene::TerrainSurface>(
            test::must(stage.node().surface->exaggerated(factor)));
        return std::pair(stage.drawn(), stage.drawn_by_opengl("exact"));
    };
    for (const double factor : {0.25, 4.0}) {
        stage.look_from_azimuth(200.0);
        const auto [rays, shaders] = with(factor);
        EXPECT_LE(test::share_of_others(rays, shaders, 6), 0.004) << factor;
        stage.node().material.technique = {scene::Exact{}};
        stage.node().hides_overlay = true;
        const Image hidden = stage.drawn();
        stage.node().hides_overlay = false;
        EXPECT_GT(changed_pixels(rays, hidden), 3000) << factor;
    }
}

} // namespace
} // namespace reljef::cast
