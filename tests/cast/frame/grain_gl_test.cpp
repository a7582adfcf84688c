#include <algorithm>
#include <array>
#include <cstdlib>

#include <gtest/gtest.h>

#include "engine/cast/frame/driver.h"
#include "engine/scene/motion/poses.h"
#include "engine/truth/image_error.h"
#include "engine/view/select.h"
#include "tests/cast/frame/compared_pictures.h"
#include "tests/cast/made_rays.h"
#include "tests/gl/gl_fixture.h"
#include "tests/session/made_session.h"

namespace reljef::cast {
namespace {

constexpr glm::ivec2 grain_picture{320, 240};

// Hills of samples 8 m apart, some of them steep, below a sun.
struct GrainyStage : Stage {
    GrainyStage() : Stage(test::hills(151, 129, 90.0), {8.0, 8.0}) {
        scene.add_light();
        node().material.technique = {scene::Exact{}};
        set_grain(1.0F);
    }
    scene::TerrainNode& node() { return *terrain->get<scene::TerrainNode>(); }
    void set_grain(float strength) { node().grain = strength; }
    void look_from(scene::Pose pose) {
        look(scene::pose_camera(pose, surface().bounds(), [&](double x, double y) {
            return surface().height_at(x, y).value_or(0.0);
        }));
    }
    // A map of the ground around a place, `metre` metres a pixel.
    void look_down_at(glm::dvec2 place, double metre) {
        scene::Camera map;
        map.projection = scene::ProjectionKind::orthographic;
        map.eye = {place, 500.0};
        map.target = {place, 0.0};
        map.up = {0.0, 1.0, 0.0};
        map.view_height = metre * grain_picture.y;
        look(map);
    }
    [[nodiscard]] Image drawn(const DriverOptions& options = {.size = grain_picture}) const {
        Driver driver = test::must(Driver::create(options));
        test::must(driver.draw(view::select(scene, grain_picture)));
        return driver.read_color();
    }
    [[nodiscard]] HitBuffer hits() const {
        Driver driver = test::must(Driver::create({.size = grain_picture}));
        return test::must(driver.draw_hits(view::select(scene, grain_picture))).hits;
    }
};

double mean_brightness(const Image& image) {
    double sum = 0.0;
    for (const Rgba8 pixel : image.samples()) {
        sum += pixel.r + pixel.g + pixel.b;
    }
    return sum / static_cast<double>(3 * image.size());
}

class GrainGlTest : public test::GlTest {};

constexpr std::array near_poses{scene::Pose::low, scene::Pose::grazing, scene::Pose::oblique};

// The shaders filter rounded texels, and their derivatives are those of four pixels.
TEST_F(GrainGlTest, RaysAndShadersShowTheSame) {
    GrainyStage stage;
    for (const char* const technique : {"exact", "polygons"}) {
        for (const scene::Pose pose : near_poses) {
            stage.look_from(pose);
            stage.node().material.technique = {scene::Exact{}};
            const Image rays = stage.drawn();
            stage.node().material.technique = test::must(scene::parse_technique(technique));
            session::SceneRenderer opengl = test::must(test::make_renderer(grain_picture));
            test::must(opengl.draw(stage.scene));
            const auto errors = truth::image_errors(rays, opengl.read_color());
            ASSERT_TRUE(errors);
            EXPECT_LE(errors->rmse, 0.02) << technique << ' ' << scene::to_string(pose);
            EXPECT_LE(test::share_of_others(rays, opengl.read_color(), 6), 0.02)
                << technique << ' ' << scene::to_string(pose);
        }
    }
}

TEST_F(GrainGlTest, ChangesGroundButNoHitAndNoSky) {
    GrainyStage stage;
    for (const scene::Pose pose : near_poses) {
        stage.look_from(pose);
        const Image grainy = stage.drawn();
        const HitBuffer with = stage.hits();
        stage.set_grain(0.0F);
        const Image plain = stage.drawn();
        const HitBuffer without = stage.hits();
        stage.set_grain(1.0F);
        int changed = 0;
        int ground = 0;
        for (int row = 0; row < grain_picture.y; ++row) {
            for (int col = 0; col < grain_picture.x; ++col) {
                const bool is_ground = !without(col, row).is_sky();
                const bool is_other = grainy(col, row) != plain(col, row);
                ASSERT_EQ(!with(col, row).is_sky(), is_ground);
                ASSERT_EQ(with(col, row).depth, without(col, row).depth);
                ASSERT_FALSE(is_other && !is_ground) << "in the sky";
                ground += is_ground ? 1 : 0;
                changed += is_other ? 1 : 0;
            }
        }
        EXPECT_GT(changed, ground / 2) << scene::to_string(pose);
        EXPECT_NEAR(mean_brightness(grainy), mean_brightness(plain), 4.0)
            << "of 255, " << scene::to_string(pose);
    }
}

// The eye moves by whole pixels over the ground: what it still sees must not change, as it would if
// patterns swam.
TEST_F(GrainGlTest, StaysWhereItIsWhenTheEyeMoves) {
    GrainyStage stage;
    constexpr glm::ivec2 way{37, -21}; // pixels
    for (const double metre : {0.05, 0.5}) {
        stage.look_down_at({100.0, 50.0}, metre);
        const Image before = stage.drawn();
        stage.look_down_at(glm::dvec2(100.0, 50.0) + metre * glm::dvec2(way.x, -way.y), metre);
        const Image after = stage.drawn();
        double largest = 0.0;
        for (int row = 0; row < grain_picture.y; ++row) {
            for (int col = 0; col < grain_picture.x; ++col) {
                const glm::ivec2 from = glm::ivec2(col, row) + way;
                if (from.x < 0 || from.y < 0 || from.x >= grain_picture.x ||
                    from.y >= grain_picture.y) {
                    continue;
                }
                const int off = std::abs(before(from.x, from.y).g - after(col, row).g);
                largest = std::max(largest, static_cast<double>(off));
            }
        }
        EXPECT_LE(largest, 2.0) << metre;
    }
}

TEST_F(GrainGlTest, EveryInstructionSetPaintsIt) {
    GrainyStage stage;
    stage.look_from(scene::Pose::low);
    const Image first = stage.drawn();
    for (const SimdTarget& target : simd_targets()) {
        const Image other = stage.drawn({.size = grain_picture, .target = target});
        EXPECT_LE(test::share_of_others(first, other, 2), 0.002) << target.name;
    }
}

} // namespace
} // namespace reljef::cast
