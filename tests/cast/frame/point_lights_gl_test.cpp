#include "engine/scene/graph/point_light.h"

#include <array>
#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "engine/truth/image_error.h"
#include "tests/cast/frame/compared_pictures.h"
#include "tests/cast/frame/overlay_stage.h"
#include "tests/gl/gl_fixture.h"
#include "tests/render/made_stream.h"
#include "tests/scene/streaming/streamed_samples.h"

namespace reljef::cast {
namespace {

constexpr scene::Light no_light{.color = glm::vec3(0.0F), .ambient = glm::vec3(0.0F)};

// Level ground in the dark, from above.
struct PlaneStage : OverlayStage {
    static constexpr double height = 50.0;
    static constexpr double metre = 0.5; // of a pixel

    PlaneStage() : OverlayStage(test::made_heights(101, 81, [](int, int) { return height; })) {
        sun() = no_light;
        look_down_at({0.0, 0.0}, metre);
    }
    // Metres from the middle.
    static glm::dvec2 place_of(int col, int row) {
        return metre *
               glm::dvec2(col + 0.5 - 0.5 * overlay_picture.x, 0.5 * overlay_picture.y - row - 0.5);
    }
    [[nodiscard]] glm::vec3 albedo() const {
        return linear_from_rgba8(scene::albedo_map(surface())(50, 40));
    }
    /// By rays, or by a technique of OpenGL.
    [[nodiscard]] Image shown(std::string_view technique) {
        return technique == "rays" ? drawn() : drawn_by_opengl(technique);
    }
};

class PointLightsGlTest : public test::GlTest {};

constexpr scene::PointLight plane_lamp{
    .color = {1.0F, 0.8F, 0.6F}, .intensity = 700.0F, .range = 45.0F};
constexpr double lamp_height = 20.0;
constexpr std::array plane_techniques{"rays", "exact", "polygons", "relief", "texture"};

int most_off(Rgba8 a, Rgba8 b) {
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

// Of white ground below a lamp at a place, a way from there: I · cos θ / d² · (1 − (d / r)⁴)².
float light_at(glm::dvec2 way) {
    const double square = glm::dot(way, way) + lamp_height * lamp_height;
    const double part = std::pow(square / (45.0 * 45.0), 2);
    const double window = std::max(1.0 - part, 0.0);
    return static_cast<float>(700.0 * lamp_height / std::pow(square, 1.5) * window * window);
}

// A byte of the result is half a level off, one of the albedo, whose root is rounded to 10 bits for
// rays, up to another, and filters round to 1/256.
TEST_F(PointLightsGlTest, LightLevelGroundByTheirLaw) {
    for (const std::string_view technique : plane_techniques) {
        PlaneStage stage;
        stage.scene.add_point_light(plane_lamp, {3.0, -2.0, PlaneStage::height + lamp_height});
        const Image picture = stage.shown(technique);
        const glm::vec3 reflected = stage.albedo() * plane_lamp.color;
        int largest = 0;
        for (int row = 0; row < picture.rows(); ++row) {
            for (int col = 0; col < picture.cols(); ++col) {
                const glm::dvec2 way = PlaneStage::place_of(col, row) - glm::dvec2(3.0, -2.0);
                largest = std::max(largest, most_off(picture(col, row),
                                                     rgba8_from_linear(reflected * light_at(way))));
            }
        }
        EXPECT_LE(largest, 2) << technique;
    }
}

TEST_F(PointLightsGlTest, LightLevelGroundAlikeFromFarAway) {
    for (const std::string_view technique : plane_techniques) {
        PlaneStage stage;
        const scene::Light light{.azimuth = 70.0, .altitude = 30.0, .color = {0.9F, 0.6F, 0.3F}};
        stage.scene.add_light(light);
        const Image picture = stage.shown(technique);
        const Rgba8 expected = rgba8_from_linear(stage.albedo() * 0.5F * light.color);
        int largest = 0;
        for (int row = 0; row < picture.rows(); ++row) {
            for (int col = 0; col < picture.cols(); ++col) {
                largest = std::max(largest, most_off(picture(col, row), expected));
            }
        }
        EXPECT_LE(largest, 2) << technique;
    }
}

TEST_F(PointLightsGlTest, EndAtTheirRange) {
    for (const std::string_view technique : plane_techniques) {
        PlaneStage stage;
        stage.sun() = {};
        const Image without = stage.shown(technique);
        stage.scene.add_point_light(plane_lamp, {0.0, 0.0, PlaneStage::height + lamp_height});
        const Image with = stage.shown(technique);
        const double end = std::sqrt(45.0 * 45.0 - lamp_height * lamp_height);
        int brighter = 0;
        for (int row = 0; row < with.rows(); ++row) {
            for (int col = 0; col < with.cols(); ++col) {
                if (glm::length(PlaneStage::place_of(col, row)) > end) {
                    ASSERT_EQ(with(col, row), without(col, row)) << technique;
                } else {
                    brighter += with(col, row).g > without(col, row).g ? 1 : 0;
                }
            }
        }
        EXPECT_GT(brighter, 5000) << technique;
    }
}

// Rough ground in the dusk, with three lamps close above it, and a far light besides the sun.
struct LampStage : OverlayStage {
    LampStage() {
        sun().altitude = 5.0;
        sun().color *= 0.1F;
        sun().ambient *= 0.1F;
        add_lamp({-120.0, -300.0}, {1.0F, 0.7F, 0.4F});
        add_lamp({60.0, -380.0}, {1.0F, 1.0F, 1.0F});
        add_lamp({100.0, 80.0}, {0.4F, 0.7F, 1.0F});
        scene.add_light({.azimuth = 60.0, .altitude = 20.0, .color = {0.0F, 0.05F, 0.1F}});
    }
    void add_lamp(glm::dvec2 place, glm::vec3 color) {
        const double ground = surface().height_at(place.x, place.y).value_or(0.0);
        scene.add_point_light({.color = color, .intensity = 3000.0F, .range = 250.0F},
                              {place, ground + 40.0});
    }
    [[nodiscard]] Image truth() const {
        return test::must(truth::draw(scene, overlay_picture)).image;
    }
};

constexpr std::array lamp_poses{scene::Pose::low, scene::Pose::oblique, scene::Pose::overview};

TEST_F(PointLightsGlTest, RaysShadersAndTheTruthShowTheSame) {
    LampStage stage;
    for (const scene::Pose pose : lamp_poses) {
        stage.look_from(pose);
        const Image exact = stage.truth();
        stage.node().material.technique = {scene::Exact{}};
        const auto of_rays = truth::image_errors(exact, stage.drawn());
        ASSERT_TRUE(of_rays);
        EXPECT_LE(of_rays->rmse, 0.01) << scene::to_string(pose);
        for (const char* const technique : {"exact", "relief", "polygons:error=0.1"}) {
            const auto errors = truth::image_errors(exact, stage.drawn_by_opengl(technique));
            ASSERT_TRUE(errors);
            EXPECT_LE(errors->rmse, 0.02) << technique << ' ' << scene::to_string(pose);
        }
    }
}

TEST_F(PointLightsGlTest, LieUnderGrain) {
    LampStage stage;
    stage.set_grain(1.0F);
    stage.node().contours = 10.0;
    for (const scene::Pose pose : lamp_poses) {
        stage.look_from(pose);
        stage.node().material.technique = {scene::Exact{}};
        const Image rays = stage.drawn();
        for (const char* const technique : {"exact", "polygons"}) {
            const auto errors = truth::image_errors(rays, stage.drawn_by_opengl(technique));
            ASSERT_TRUE(errors);
            EXPECT_LE(errors->rmse, 0.02) << technique << ' ' << scene::to_string(pose);
        }
    }
}

TEST_F(PointLightsGlTest, LightMeshes) {
    LampStage stage;
    stage.add_lamp({-120.0, -250.0}, {1.0F, 1.0F, 1.0F});
    const double ground = stage.surface().height_at(-100.0, -260.0).value_or(0.0);
    scene::Material pale;
    pale.color = glm::vec3(0.6F, 0.7F, 0.8F);
    stage.scene.add_mesh(scene::sphere_mesh(25.0F), pale).set_position({-90.0, -260.0, ground});
    stage.look(test::camera_at({-100.0, -360.0, ground + 60.0}, {-90.0, -260.0, ground}));
    const auto pictures = [&] {
        stage.node().material.technique = {scene::Exact{}};
        return std::array{stage.drawn(), stage.truth(),
                          stage.drawn_by_opengl("polygons:error=0.1")};
    };
    const auto lit = pictures();
    for (const Image& other : {lit[1], lit[2]}) {
        EXPECT_LE(truth::image_errors(lit[0], other)->rmse, 0.02);
        EXPECT_LE(test::share_of_others(lit[0], other, 10), 0.02);
    }
    stage.scene.root().children().back()->set_visible(false);
    EXPECT_GT(test::share_of_others(lit[0], stage.drawn(), 10), 0.05) << "the mesh is seen";
}

TEST_F(PointLightsGlTest, LightTilesOfStreams) {
    for (const char* const technique : {"exact", "polygons"}) {
        LampStage stage;
        LampStage streamed;
        test::stream_samples(streamed.node(), test::SeenLevels::finest);
        for (LampStage* const made : {&stage, &streamed}) {
            made->look_from(scene::Pose::low);
            made->node().material.technique = test::must(scene::parse_technique(technique));
        }
        render::bring_tiles(streamed.scene, overlay_picture);
        const Image in_memory = stage.drawn_by_opengl(technique);
        const Image tiles = streamed.drawn_by_opengl(technique);
        EXPECT_LE(truth::image_errors(in_memory, tiles)->rmse, 0.02) << technique;
        streamed.node().material.technique = {scene::Exact{}};
        EXPECT_LE(truth::image_errors(in_memory, streamed.drawn())->rmse, 0.02) << technique;
    }
}

TEST_F(PointLightsGlTest, EveryInstructionSetPaintsThem) {
    LampStage stage;
    stage.look_from(scene::Pose::low);
    const Image first = stage.drawn();
    for (const SimdTarget& target : simd_targets()) {
        const Image other = stage.drawn({.size = overlay_picture, .target = target});
        EXPECT_LE(test::share_of_others(first, other, 2), 0.002) << target.name;
    }
}

TEST_F(PointLightsGlTest, ChangeNoHitAndNoWork) {
    LampStage with;
    OverlayStage without;
    const auto costs = [](const OverlayStage& stage) {
        Driver driver = test::must(Driver::create({.size = overlay_picture}));
        return test::must(driver.count_work(view::select(stage.scene, overlay_picture)));
    };
    with.look_from(scene::Pose::low);
    without.look_from(scene::Pose::low);
    const HitBuffer hits = with.hits();
    const HitBuffer plain = without.hits();
    for (int row = 0; row < overlay_picture.y; ++row) {
        for (int col = 0; col < overlay_picture.x; ++col) {
            ASSERT_EQ(hits(col, row).depth, plain(col, row).depth);
        }
    }
    EXPECT_TRUE(std::ranges::equal(costs(with).pixels.samples(), costs(without).pixels.samples()));
}

// Out of the view, no shader and no map is another one.
TEST_F(PointLightsGlTest, CostNothingOutOfTheView) {
    const auto drawn = [](bool has_lamp) {
        OverlayStage stage;
        stage.look_from(scene::Pose::low);
        if (has_lamp) {
            stage.scene.add_point_light({.range = 50.0F}, {0.0, 0.0, 5000.0});
        }
        stage.node().material.technique = test::must(scene::parse_technique("polygons"));
        session::SceneRenderer opengl = test::must(test::make_renderer(overlay_picture));
        return test::must(opengl.draw(stage.scene));
    };
    const view::FrameStats with = drawn(true);
    const view::FrameStats without = drawn(false);
    EXPECT_EQ(with.upload_bytes, without.upload_bytes);
    EXPECT_EQ(with.state_changes, without.state_changes);
}

} // namespace
} // namespace reljef::cast
