#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "engine/cast/frame/driver.h"
#include "engine/scene/motion/poses.h"
#include "engine/terrain/field/ray_cast.h"
#include "engine/truth/image_error.h"
#include "tests/cast/made_rays.h"
#include "tests/gl/gl_fixture.h"
#include "tests/render/made_stream.h"
#include "tests/scene/streaming/streamed_samples.h"
#include "tests/session/made_session.h"

namespace reljef::cast {
namespace {

constexpr glm::ivec2 shadow_picture{320, 240};

// Hills, and towers with sharp shadows.
Grid<float> hills_and_towers() {
    Grid<float> heights = test::hills(301, 257, 14.0);
    for (const glm::ivec2 tower :
         {glm::ivec2(90, 60), glm::ivec2(150, 128), glm::ivec2(230, 190)}) {
        for (int i = 0; i < 144; ++i) {
            heights(tower.x + i % 12, tower.y + i / 12) += 70.0F;
        }
    }
    return heights;
}

struct SunnyStage : Stage {
    scene::Light sun;

    explicit SunnyStage(double altitude = 17.0) : Stage(hills_and_towers(), {1.0, 1.0}) {
        sun.azimuth = 250.0;
        sun.altitude = altitude;
        scene.add_light(sun);
        set_shadow(true);
    }
    void set_shadow(bool is_cast) {
        scene::Technique technique{scene::Exact{}};
        if (is_cast) {
            technique.options.shadow = scene::Shadow{.depth = 0.0};
        }
        terrain->get<scene::TerrainNode>()->material.technique = technique;
    }
    void look_from(scene::Pose pose) {
        look(scene::pose_camera(pose, surface().bounds(), [&](double x, double y) {
            return surface().height_at(x, y).value_or(0.0);
        }));
    }
    [[nodiscard]] Image drawn(const DriverOptions& options = {.size = shadow_picture}) const {
        Driver driver = test::must(Driver::create(options));
        test::must(driver.draw(view::select(scene, options.size)));
        return driver.read_color();
    }

    // Whether the sun is visible from just above the ground, in double precision.
    [[nodiscard]] bool is_lit(glm::dvec3 sample, double above) const {
        const glm::dvec3 local = scene::to_light(sun); // the node has no transform
        const glm::dvec3 to_sun = direction_in_samples(surface().placement(), local);
        const Ray ray{sample + glm::dvec3(0.0, 0.0, above), to_sun};
        return !terrain::first_hit(surface().heightfield().heights.view(), surface().pyramid(), ray,
                                   {0.0, 1e4});
    }
};

int difference(Rgba8 a, Rgba8 b) {
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

struct LightCounts {
    int lit = 0; // pixels
    int hidden = 0;
    int wrong = 0;
};

// What a place looks like with and without the sun.
class ExpectedLight {
public:
    explicit ExpectedLight(const SunnyStage& stage)
        : stage_(stage), irradiance_(stage.surface(), {stage.sun, glm::dmat3(1.0)}),
          albedo_(scene::albedo_map(stage.surface())) {}

    void add(const Hit& hit, Rgba8 shown, LightCounts& counts) const {
        const glm::dvec3 place(hit.place(), hit.height);
        const bool is_lit = stage_.is_lit(place, 1e-4);
        if (is_lit != stage_.is_lit(place, 0.02)) {
            return; // the edge of a shadow
        }
        const glm::vec3 color = linear_from_rgba8(albedo_.clamped(
            static_cast<int>(std::lround(hit.col)), static_cast<int>(std::lround(hit.row))));
        const scene::IrradianceParts parts = irradiance_.parts_at(hit.place());
        const Rgba8 dark = rgba8_from_linear(color * parts.sky);
        const Rgba8 bright = rgba8_from_linear(color * (parts.sky + parts.sun));
        if (difference(dark, bright) < 20) {
            return; // the sun adds little
        }
        ++(is_lit ? counts.lit : counts.hidden);
        const bool is_bright = difference(shown, bright) < difference(shown, dark);
        counts.wrong += is_bright == is_lit ? 0 : 1;
    }

private:
    const SunnyStage& stage_;
    scene::TerrainIrradiance irradiance_;
    Image albedo_;
};

// Each pixel has the light of the sky, and that of the sun where a ray of doubles reaches it.
TEST(SunShadow, IsThatOfTheTruth) {
    SunnyStage stage;
    const ExpectedLight expected(stage);
    for (const scene::Pose pose : {scene::Pose::overview, scene::Pose::low, scene::Pose::map}) {
        stage.look_from(pose);
        const Image shown = stage.drawn();
        const HitBuffer hits = stage.truth(shadow_picture);
        LightCounts counts;
        for (int row = 0; row < shown.rows(); ++row) {
            for (int col = 0; col < shown.cols(); ++col) {
                if (!hits(col, row).is_sky()) {
                    expected.add(hits(col, row), shown(col, row), counts);
                }
            }
        }
        EXPECT_GT(counts.lit, 10'000) << scene::to_string(pose);
        EXPECT_GT(counts.hidden, 1000) << scene::to_string(pose);
        EXPECT_LE(counts.wrong, (counts.lit + counts.hidden) / 2000) << scene::to_string(pose);
    }
}

TEST(SunShadow, HasTheSameBitsOnAnyThreads) {
    SunnyStage stage;
    stage.look_from(scene::Pose::low);
    for (const int samples : {1, 4}) {
        EXPECT_EQ(stage.drawn({.size = shadow_picture, .threads = 1, .samples = samples}),
                  stage.drawn({.size = shadow_picture, .threads = 3, .samples = samples}));
    }
}

TEST(SunShadow, IsNoneAtNight) {
    SunnyStage stage(-5.0);
    stage.look_from(scene::Pose::low);
    const Image shadowed = stage.drawn();
    stage.set_shadow(false);
    EXPECT_EQ(shadowed, stage.drawn());
}

// Where hidden from the picture, too: the tower of the second view stands beside it.
TEST(SunShadow, IsThatOfStreamedTiles) {
    SunnyStage stage;
    SunnyStage streamed;
    auto& node = *streamed.terrain->get<scene::TerrainNode>();
    test::stream_samples(node, test::SeenLevels::finest);
    const auto place = [&](double col, double row, double height) {
        return stage.surface().placement().world_from_sample({col, row, height});
    };
    scene::Camera over = test::camera_at(place(158.0, 250.0, 60.0), place(158.0, 128.0, 0.0));
    scene::Camera beside = test::camera_at(place(250.0, 90.0, 160.0), place(240.0, 100.0, 0.0));
    beside.vertical_fov = 12.0;
    for (const scene::Camera& camera : {over, beside}) {
        stage.look(camera);
        streamed.look(camera);
        render::bring_tiles(streamed.scene, shadow_picture);
        const Image in_memory = stage.drawn();
        const auto errors = truth::image_errors(streamed.drawn(), in_memory);
        ASSERT_TRUE(errors);
        EXPECT_LE(errors->rmse, 0.025); // coarser tiles beside the picture
        streamed.set_shadow(false);
        stage.set_shadow(false);
        const auto without = truth::image_errors(stage.drawn(), in_memory);
        ASSERT_TRUE(without);
        EXPECT_GT(without->rmse, 0.02); // there are shadows, and softer ones in the map of light
        streamed.set_shadow(true);
        stage.set_shadow(true);
    }
}

class SunShadowGlTest : public test::GlTest {};

TEST_F(SunShadowGlTest, IsThatOfTheShaders) {
    SunnyStage stage;
    stage.scene.set_sky({.visibility = 900.0, .plane = {}});
    for (const scene::Pose pose : {scene::Pose::overview, scene::Pose::low}) {
        stage.look_from(pose);
        session::SceneRenderer made = test::must(test::make_renderer(shadow_picture));
        test::must(made.draw(stage.scene));
        const auto errors = truth::image_errors(stage.drawn(), made.read_color());
        ASSERT_TRUE(errors);
        EXPECT_LE(errors->rmse, 0.01) << scene::to_string(pose);
        EXPECT_LE(errors->flip.mean, 0.02) << scene::to_string(pose);
    }
}

} // namespace
} // namespace reljef::cast
