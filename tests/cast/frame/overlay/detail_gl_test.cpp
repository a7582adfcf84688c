#include "engine/cast/frame/ground_detail.h"

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>

#include <gtest/gtest.h>

#include "engine/cast/frame/ray_support.h"
#include "engine/truth/image_error.h"
#include "tests/cast/frame/compared_pictures.h"
#include "tests/cast/frame/overlay_stage.h"
#include "tests/gl/gl_fixture.h"
#include "tests/render/made_stream.h"
#include "tests/scene/streaming/streamed_samples.h"

namespace reljef::cast {
namespace {

// Waves of stone, a little shiny. The maps have different sizes, and no side is a power of two.
std::shared_ptr<const material::ReliefMaterial> stones() {
    material::ReliefMaterial set;
    const auto wave = [](int i, int count, double waves) {
        return std::sin(2.0 * std::numbers::pi * waves * (i + 0.5) / count);
    };
    set.heights = Grid<float>(45, 30);
    for (int row = 0; row < 30; ++row) {
        for (int col = 0; col < 45; ++col) {
            set.heights(col, row) =
                static_cast<float>(0.5 + 0.25 * wave(col, 45, 2.0) + 0.25 * wave(row, 30, 1.0));
        }
    }
    set.color = Image(24, 36);
    for (int row = 0; row < 36; ++row) {
        for (int col = 0; col < 24; ++col) {
            const auto gray = static_cast<std::uint8_t>(130.0 + 60.0 * wave(col + row, 12, 1.0));
            set.color(col, row) = {gray, 150, static_cast<std::uint8_t>(255 - gray), 255};
        }
    }
    set.scale = 0.2F;
    set.specular = 0.2F;
    return std::make_shared<const material::ReliefMaterial>(
        test::must(material::completed(std::move(set), material::WrapMode::wrap)));
}

std::shared_ptr<const scene::TerrainDetail> detail_by(std::string_view technique) {
    static const std::shared_ptr<const material::ReliefMaterial> set = stones();
    scene::TerrainDetail detail;
    detail.set = set;
    detail.width = 60.0;
    detail.scale = 0.15F;
    detail.technique = test::must(scene::parse_technique(technique));
    return std::make_shared<const scene::TerrainDetail>(std::move(detail));
}

constexpr std::string_view bounded = "polygons:error=0.1";
constexpr std::string_view shadowed = "polygons:error=0.1,shadow=hard";

// Hills below a low sun, with stones.
struct DetailStage : OverlayStage {
    explicit DetailStage(std::string_view technique, std::string_view of_terrain = bounded) {
        sun().altitude = 25.0;
        node().detail = detail_by(technique);
        node().material.technique = test::must(scene::parse_technique(of_terrain));
        look_from(scene::Pose::low);
    }
    [[nodiscard]] Image plain() {
        const auto detail = std::exchange(node().detail, nullptr);
        Image picture = drawn();
        node().detail = detail;
        return picture;
    }
    [[nodiscard]] Result<void> support() const {
        return check_support(view::select(scene, overlay_picture).list);
    }
};

double rmse(const Image& one, const Image& other) {
    return truth::image_errors(one, other)->rmse;
}

constexpr std::array detail_poses{scene::Pose::low, scene::Pose::oblique, scene::Pose::overview};
constexpr std::array searches{"normal",
                              "steep",
                              "relief",
                              "interval",
                              "pom",
                              "relief:n=3,k=0",
                              "relief:steps=3..20",
                              "parallax",
                              "parallax-limited",
                              "parallax-iterated"};

class DetailGlTest : public test::GlTest {};

TEST_F(DetailGlTest, LooksAsWithOpenGl) {
    for (const char* const technique : searches) {
        DetailStage stage(technique);
        for (const scene::Pose pose : detail_poses) {
            stage.look_from(pose);
            const Image rays = stage.drawn();
            const double off = rmse(rays, stage.drawn_by_opengl(bounded));
            EXPECT_LE(off, 0.012) << technique << ' ' << scene::to_string(pose);
            EXPECT_GE(rmse(rays, stage.plain()), 1.5 * off) << technique;
        }
    }
}

TEST_F(DetailGlTest, ReliefHidesAsWithOpenGlCloseToTheGround) {
    DetailStage flat("normal");
    for (const char* const technique : {"steep", "relief", "interval", "pom", "parallax",
                                        "parallax-limited", "parallax-iterated"}) {
        DetailStage stage(technique);
        const double ground = stage.surface().height_at(0.0, 0.0).value_or(0.0);
        const scene::Camera close =
            test::camera_at({0.0, 0.0, ground + 12.0}, {60.0, 100.0, ground});
        stage.look(close);
        flat.look(close);
        const Image rays = stage.drawn();
        const double off = rmse(rays, stage.drawn_by_opengl(bounded));
        EXPECT_LE(off, 0.01) << technique;
        EXPECT_GE(rmse(rays, flat.drawn()), 0.05) << technique;
    }
}

TEST_F(DetailGlTest, LooksAsWithOpenGlOnAMap) {
    for (const char* const technique : {"normal", "relief"}) {
        DetailStage stage(technique);
        stage.look_down_at({20.0, -30.0}, 0.8);
        const double off = rmse(stage.drawn(), stage.drawn_by_opengl(bounded));
        EXPECT_LE(off, 0.03) << technique; // OpenGL's details have the sky's light of free planes
    }
}

TEST_F(DetailGlTest, LiesInShadowsThatRaysFind) {
    DetailStage stage("relief", shadowed);
    stage.sun().altitude = 12.0;
    const double off = rmse(stage.drawn(), stage.drawn_by_opengl(shadowed));
    EXPECT_LE(off, 0.012);
}

TEST_F(DetailGlTest, IsSeenWithoutASunAndAtNight) {
    for (const double altitude : {-8.0, 3.0}) {
        DetailStage stage("relief");
        stage.sun().altitude = altitude;
        stage.sun().ambient = glm::vec3(0.5F);
        const double off = rmse(stage.drawn(), stage.drawn_by_opengl(bounded));
        EXPECT_LE(off, 0.012) << altitude;
    }
    DetailStage stage("relief");
    stage.light->set_visible(false);
    const double off = rmse(stage.drawn(), stage.drawn_by_opengl(bounded));
    EXPECT_LE(off, 0.012);
}

TEST_F(DetailGlTest, LiesOnTilesOfStreams) {
    for (const std::string_view of_terrain : {bounded, shadowed}) {
        DetailStage whole("relief", of_terrain);
        DetailStage streamed("relief", of_terrain);
        test::stream_samples(streamed.node(), test::SeenLevels::finest);
        render::bring_tiles(streamed.scene, overlay_picture);
        const Image tiles = streamed.drawn();
        EXPECT_LE(rmse(whole.drawn(), tiles), 0.002) << of_terrain;
        EXPECT_GE(rmse(streamed.plain(), tiles), 0.03) << of_terrain;
    }
}

TEST_F(DetailGlTest, HidesGrainAndContours) {
    DetailStage stage("relief");
    const Image without = stage.drawn();
    stage.set_grain(1.0F);
    stage.node().contours = 10.0;
    const Image with = stage.drawn();
    int alike = 0;
    int others = 0;
    for (int col = 0; col < overlay_picture.x; ++col) {
        alike += with(col, overlay_picture.y - 1) == without(col, overlay_picture.y - 1) ? 1 : 0;
        for (int row = 0; row < overlay_picture.y; ++row) {
            others += with(col, row) == without(col, row) ? 0 : 1;
        }
    }
    EXPECT_EQ(alike, overlay_picture.x) << "the ground before the camera";
    EXPECT_GT(others, 500) << "far ground has no detail";
}

TEST_F(DetailGlTest, EveryInstructionSetPaintsIt) {
    DetailStage stage("relief");
    const Image first = stage.drawn();
    for (const SimdTarget& target : simd_targets()) {
        const Image other = stage.drawn({.size = overlay_picture, .target = target});
        EXPECT_LE(test::share_of_others(first, other, 4), 0.01) << target.name;
    }
}

// A driver keeps what it made of tiles.
TEST_F(DetailGlTest, NothingOfAnotherLightIsKept) {
    for (const bool is_streamed : {false, true}) {
        DetailStage stage("relief");
        if (is_streamed) {
            test::stream_samples(stage.node(), test::SeenLevels::finest);
            render::bring_tiles(stage.scene, overlay_picture);
        }
        Driver driver = test::must(Driver::create({.size = overlay_picture}));
        const auto is_as_new = [&](std::string_view technique) {
            stage.node().material.technique = test::must(scene::parse_technique(technique));
            test::must(driver.draw(view::select(stage.scene, overlay_picture)));
            return driver.read_color() == stage.drawn();
        };
        EXPECT_TRUE(is_as_new(bounded)) << is_streamed;
        EXPECT_TRUE(is_as_new(shadowed)) << is_streamed << ": rays decide where the sun is seen";
        EXPECT_TRUE(is_as_new(bounded)) << is_streamed << ": maps do";
        stage.sun().azimuth += 90.0;
        EXPECT_TRUE(is_as_new(bounded)) << is_streamed;
        const auto detail = std::exchange(stage.node().detail, nullptr);
        stage.sun().azimuth += 90.0;
        EXPECT_TRUE(is_as_new(bounded)) << is_streamed << ": without detail";
        stage.node().detail = detail;
        EXPECT_TRUE(is_as_new(bounded)) << is_streamed << ": with detail again";
    }
}

TEST_F(DetailGlTest, ChangesNoHit) {
    DetailStage stage("relief");
    const HitBuffer with = stage.hits();
    stage.node().detail = nullptr;
    const HitBuffer without = stage.hits();
    for (int row = 0; row < overlay_picture.y; ++row) {
        for (int col = 0; col < overlay_picture.x; ++col) {
            ASSERT_EQ(with(col, row).height, without(col, row).height);
        }
    }
}

TEST_F(DetailGlTest, WithOtherTechniquesIsRefusedByName) {
    for (const char* const technique :
         {"bump", "emboss", "cone", "exact", "relief:n=11,k=8,shadow=hard"}) {
        DetailStage stage(technique);
        const auto possible = stage.support();
        ASSERT_FALSE(possible) << technique;
        EXPECT_NE(possible.error().message.find("a detail texture with technique " +
                                                std::string(technique)),
                  std::string::npos)
            << possible.error().message;
    }
}

} // namespace
} // namespace reljef::cast
