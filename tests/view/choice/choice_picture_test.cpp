#include "engine/view/choice/choice_picture.h"

#include <gtest/gtest.h>

#include "engine/view/select.h"
#include "tests/render/made_scene.h"

namespace reljef::view {
namespace {

TEST(ChoicePictureTest, TintsTrianglesAndRaysAndKeepsTheSky) {
    scene::Scene scene;
    test::add_terrain(scene, test::plane_heightfield(test::hills(257, 129, 12.0)));
    scene.add_camera(test::camera_at({0.0, -200.0, 90.0}, {0.0, 0.0, 0.0}));
    DrawList list = select(scene, {3, 1}).list;
    ASSERT_EQ(list.tiles.size(), 2U);
    list.stats.choice = Choice{.tiles_as_triangles = 1, .tiles_by_rays = 1};
    std::erase_if(list.tiles, [](const TileDraw& draw) { return draw.tile->first.x > 0; });
    HitBuffer hits(3, 1);
    hits(0, 0) = hit_at({10.0, 10.0}, 1.0, 5.0);
    hits(1, 0) = hit_at({200.0, 10.0}, 1.0, 5.0);
    const Rgba8 grey{120, 120, 120};
    Image picture(3, 1, grey);
    tint_choice(picture, hits, list);
    EXPECT_GT(picture(0, 0).r, picture(0, 0).b) << "triangles are orange";
    EXPECT_GT(picture(1, 0).b, picture(1, 0).r) << "rays are blue";
    EXPECT_EQ(picture(2, 0), grey) << "the sky";

    list.stats.choice = Choice{.tiles_by_rays = 1};
    picture = Image(3, 1, grey);
    tint_choice(picture, hits, list);
    EXPECT_GT(picture(0, 0).b, picture(0, 0).r) << "rays on the CPU draw listed tiles";
}

TEST(ChoicePictureTest, TintsUnprovenSearchesInAColourOfTheirOwn) {
    DrawList list;
    list.stats.choice = Choice{.tiles_by_rays = 1, .typical = TypicalChoice{"interval:n=4", 0.95}};
    HitBuffer hits(1, 1);
    hits(0, 0) = hit_at({1.0, 1.0}, 0.0, 1.0);
    Image picture(1, 1, Rgba8{120, 120, 120});
    tint_choice(picture, hits, list);
    EXPECT_GT(picture(0, 0).r, picture(0, 0).b);
    EXPECT_NE(color_of_typical(), color_of_triangles());
    EXPECT_NE(color_of_typical(), color_of_rays(0));
}

TEST(ChoicePictureTest, BrighterPixelsStayBrighter) {
    const DrawList nothing;
    HitBuffer hits(2, 1);
    hits(0, 0) = hits(1, 0) = hit_at({1.0, 1.0}, 0.0, 1.0);
    Image picture(2, 1);
    picture(0, 0) = {20, 20, 20};
    picture(1, 0) = {220, 220, 220};
    tint_choice(picture, hits, nothing);
    EXPECT_LT(picture(0, 0).b, picture(1, 0).b);
    EXPECT_NE(color_of_rays(0), color_of_rays(1));
    EXPECT_EQ(color_of_rays(99), color_of_rays(4));
}

} // namespace
} // namespace reljef::view
