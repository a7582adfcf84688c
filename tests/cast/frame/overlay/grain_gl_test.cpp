#include <algorithm>
#include <array>
#include <cstdlib>
#include <span>
#include <utility>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/vec3.hpp>
#include <gtest/gtest.h>

#include "engine/material/grain_map.h"
#include "engine/scene/graph/daylight.h"
#include "engine/scene/motion/poses.h"
#include "engine/truth/image_error.h"
#include "tests/cast/frame/compared_pictures.h"
#include "tests/cast/frame/overlay_stage.h"
#include "tests/gl/gl_fixture.h"
#include "tests/session/made_session.h"
#include "tests/support/release_only.h"

namespace reljef::cast {
namespace {

namespace numbers {
#include "shaders/terrain/overlay_numbers.inc"
}

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
    OverlayStage stage;
    stage.set_grain(1.0F);
    for (const char* const technique : {"exact", "polygons"}) {
        for (const scene::Pose pose :
             std::span(near_poses).first(std::size_t{test::rounds(3, 1)})) {
            stage.look_from(pose);
            stage.node().material.technique = {scene::Exact{}};
            const Image rays = stage.drawn();
            const Image shaders = stage.drawn_by_opengl(technique);
            const auto errors = truth::image_errors(rays, shaders);
            ASSERT_TRUE(errors);
            EXPECT_LE(errors->rmse, 0.02) << technique << ' ' << scene::to_string(pose);
            EXPECT_LE(test::share_of_others(rays, shaders, 6), 0.02)
                << technique << ' ' << scene::to_string(pose);
        }
    }
}

// They have another shader.
TEST_F(GrainGlTest, FarTilesLoseNone) {
    Grid<float> heights = test::hills(301, 259, 30.0);
    for (float& height : heights.samples()) {
        height += 1000.0F;
    }
    OverlayStage stage(std::move(heights), {1.0, 1.0});
    stage.look_from(scene::Pose::low);
    const Image plain = stage.drawn_by_opengl("polygons");
    stage.set_grain(1.0F);
    const Image grainy = stage.drawn_by_opengl("polygons");
    EXPECT_GT(test::share_of_others(grainy, plain, 6), 0.1);
    stage.node().contours = 1e6; // no line is seen, but all tiles have the shader of overlays
    EXPECT_EQ(test::share_of_others(grainy, stage.drawn_by_opengl("polygons"), 1), 0.0);
}

// In a view without perspective, the eye is anywhere on its rays.
TEST_F(GrainGlTest, MapsDoNotDependOnTheHeightOfTheEye) {
    OverlayStage stage;
    stage.set_grain(1.0F);
    stage.look_down_at({100.0, 50.0}, 0.5);
    const Image rays = stage.drawn();
    for (const double height : {150.0, 5000.0}) {
        scene::Camera map = stage.scene.camera();
        map.eye.z = height;
        stage.look(map);
        EXPECT_LE(test::share_of_others(rays, stage.drawn_by_opengl("exact"), 6), 0.02) << height;
        EXPECT_LE(test::share_of_others(rays, stage.drawn(), 2), 0.001) << height;
    }
}

TEST_F(GrainGlTest, ChangesGroundButNoHitAndNoSky) {
    OverlayStage stage;
    stage.set_grain(1.0F);
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
        for (int row = 0; row < overlay_picture.y; ++row) {
            for (int col = 0; col < overlay_picture.x; ++col) {
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

TEST(GrainNumbers, LayersOfShadersAreThoseOfTheMap) {
    EXPECT_EQ(static_cast<int>(numbers::scree_layer), material::GrainMap::scree);
    EXPECT_EQ(static_cast<int>(numbers::grass_layer), material::GrainMap::grass);
    EXPECT_EQ(static_cast<int>(numbers::rock_layer), material::GrainMap::rock);
    EXPECT_EQ(static_cast<int>(numbers::snow_layer), material::GrainMap::snow);
}

Grid<float> inclined(float slope) {
    Grid<float> heights(129, 129);
    for (int row = 0; row < heights.rows(); ++row) {
        for (int col = 0; col < heights.cols(); ++col) {
            heights(col, row) = 8.0F * slope * static_cast<float>(col);
        }
    }
    return heights;
}

// How much grain changes a colour: the standard deviation of its channels, in parts of their means.
glm::dvec3 contrast_of(Rgba8 color, float slope, double altitude = 40.0) {
    Image image(2, 2);
    std::fill(image.samples().begin(), image.samples().end(), color);
    OverlayStage stage(inclined(slope), {8.0, 8.0}, std::move(image));
    const scene::Daylight daylight = scene::daylight_at(altitude, scene::default_turbidity);
    stage.sun() = {.altitude = altitude, .color = daylight.sun, .ambient = daylight.ambient};
    stage.set_grain(1.0F);
    stage.look_down_at({100.0, 50.0}, 0.5);
    glm::dvec3 sum(0.0);
    glm::dvec3 squares(0.0);
    const Image drawn = stage.drawn();
    for (const Rgba8 pixel : drawn.samples()) {
        const glm::dvec3 seen(pixel.r, pixel.g, pixel.b);
        sum += seen;
        squares += seen * seen;
    }
    const glm::dvec3 mean = sum / static_cast<double>(drawn.size());
    return glm::sqrt(squares / static_cast<double>(drawn.size()) - mean * mean) / mean;
}

constexpr Rgba8 brown{150, 120, 90, 255};
constexpr Rgba8 grey{134, 127, 120, 255};
constexpr Rgba8 green{112, 134, 80, 255};
constexpr Rgba8 white{207, 212, 219, 255};

TEST_F(GrainGlTest, OnlyGrassChangesItsHue) {
    const auto hue_of = [](glm::dvec3 contrast) { return contrast.r / contrast.g; };
    EXPECT_GT(hue_of(contrast_of(green, 0.1F)), 1.1);
    for (const Rgba8 other : {brown, grey}) {
        EXPECT_NEAR(hue_of(contrast_of(other, 0.1F)), 1.0, 0.05) << int{other.b};
    }
    EXPECT_NEAR(hue_of(contrast_of(green, 1.5F)), 1.0, 0.05) << "rock, as steep as it is";
}

TEST_F(GrainGlTest, SnowIsSmoothInAnyLight) {
    for (const double altitude : {60.0, 12.0, 0.0, -3.0}) {
        for (const float slope : {0.1F, 1.5F}) {
            const double rough = contrast_of(grey, slope, altitude).g;
            EXPECT_GT(rough, 0.02) << altitude << ' ' << slope;
            EXPECT_LT(contrast_of(white, slope, altitude).g, 0.5 * rough)
                << altitude << ' ' << slope;
        }
    }
}

TEST_F(GrainGlTest, RaysAndShadersShowTheSameKinds) {
    Image stripes(6, 1);
    std::ranges::copy(std::array{brown, green, grey, white, green, brown},
                      stripes.samples().begin());
    for (const float slope : {0.1F, 1.5F}) {
        OverlayStage stage(inclined(slope), {8.0, 8.0}, stripes);
        stage.set_grain(1.0F);
        stage.look_down_at({0.0, 0.0}, 2.0);
        const Image rays = stage.drawn();
        const Image shaders = stage.drawn_by_opengl("exact");
        EXPECT_LE(test::share_of_others(rays, shaders, 6), 0.02) << slope;
    }
}

// The eye moves by whole pixels over the ground: what it still sees must not change, as it would if
// patterns swam.
TEST_F(GrainGlTest, StaysWhereItIsWhenTheEyeMoves) {
    OverlayStage stage;
    stage.set_grain(1.0F);
    constexpr glm::ivec2 way{37, -21}; // pixels
    for (const double metre : {0.05, 0.5}) {
        stage.look_down_at({100.0, 50.0}, metre);
        const Image before = stage.drawn();
        stage.look_down_at(glm::dvec2(100.0, 50.0) + metre * glm::dvec2(way.x, -way.y), metre);
        const Image after = stage.drawn();
        int changed = 0;
        for (int row = 0; row < overlay_picture.y; ++row) {
            for (int col = 0; col < overlay_picture.x; ++col) {
                const glm::ivec2 from = glm::ivec2(col, row) + way;
                if (from.x < 0 || from.y < 0 || from.x >= overlay_picture.x ||
                    from.y >= overlay_picture.y) {
                    continue;
                }
                const int off = std::abs(before(from.x, from.y).g - after(col, row).g);
                EXPECT_LE(off, 8) << metre;
                changed += off > 2 ? 1 : 0;
            }
        }
        EXPECT_LE(changed, 30) << "rounding decides on the line between two kinds; " << metre;
    }
}

TEST_F(GrainGlTest, EveryInstructionSetPaintsIt) {
    OverlayStage stage;
    stage.set_grain(1.0F);
    stage.look_from(scene::Pose::low);
    const Image first = stage.drawn();
    for (const SimdTarget& target : simd_targets()) {
        const Image other = stage.drawn({.size = overlay_picture, .target = target});
        EXPECT_LE(test::share_of_others(first, other, 2), 0.002) << target.name;
    }
}

} // namespace
} // namespace reljef::cast
