#include <memory>

#include <gtest/gtest.h>

#include "engine/material/relief_material.h"
#include "engine/truth/image_error.h"
#include "tests/render/driver_fixture.h"
#include "tests/session/made_session.h"

namespace reljef::render {
namespace {

// Light and dark fields, flat.
std::shared_ptr<const scene::TerrainDetail> fields(double width) {
    constexpr int side = 64;
    material::ReliefMaterial set;
    set.name = "fields";
    set.heights = Grid<float>(side, side, 1.0F);
    set.color = Image(side, side, Rgba8{});
    for (int row = 0; row < side; ++row) {
        for (int col = 0; col < side; ++col) {
            const bool is_light = (col / (side / 2) + row / (side / 2)) % 2 == 0;
            set.color(col, row) = is_light ? Rgba8{220, 220, 220, 255} : Rgba8{70, 70, 70, 255};
        }
    }
    set.specular = 0.0F;
    scene::TerrainDetail detail;
    detail.set = std::make_shared<const material::ReliefMaterial>(
        material::completed(std::move(set), material::WrapMode::wrap).value());
    detail.width = width;
    detail.technique = scene::parse_technique("relief").value();
    return std::make_shared<const scene::TerrainDetail>(std::move(detail));
}

class SliverDetailsGlTest : public DriverGlTest {};

// The longest side of a narrow triangle counted as its width: details on walls were blurred.
TEST_F(SliverDetailsGlTest, DetailsOnWallsAreAsSharpAsWithAllTriangles) {
    Scene scene;
    Node& terrain = test::add_terrain(
        scene, test::plane_heightfield(test::made_heights(
                   41, 41, [](int /*col*/, int row) { return row < 20 ? 60.0 : 0.0; })));
    scene.add_light();
    scene.add_camera(camera_at({3.0, -25.0, 20.0}, {0.0, 0.0, 25.0}));
    auto& node = *terrain.get<scene::TerrainNode>();
    node.detail = fields(8.0);
    session::SceneRenderer made = driver();
    const auto picture = [&](const char* technique) {
        node.material.technique = scene::parse_technique(technique).value();
        const view::FrameStats stats = test::must(made.draw(scene));
        EXPECT_EQ(stats.slivers > 0, std::string_view(technique) != "polygons");
        return made.read_color();
    };
    const Image all = picture("polygons");
    for (const char* const technique : {"polygons:error=1", "polygons:error=0.1"}) {
        const auto errors = truth::image_errors(picture(technique), all);
        ASSERT_TRUE(errors);
        EXPECT_LT(errors->rmse, 0.02) << technique;
    }
}

} // namespace
} // namespace reljef::render
