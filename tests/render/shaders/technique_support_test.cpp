#include "engine/render/shaders/technique_support.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/view/select.h"
#include "tests/render/made_scene.h"

namespace reljef::render {
namespace {

using scene::TechniqueId;
using testing::HasSubstr;

gl::Limits usual_limits() {
    gl::Limits limits;
    limits.version = "4.5 (Core Profile) Mesa 22.3.6";
    limits.max_texture_size = 16384;
    limits.max_texture_units = 80;
    limits.max_fragment_texture_units = 16; // the least that OpenGL 4.5 allows
    return limits;
}

constexpr DrawnSurface usual_terrain{false, {1025, 1025}};
constexpr DrawnSurface usual_tile{true, {512, 512}};

TEST(TechniqueSupport, LeastOfWhatOpenGl45HasDrawsEveryTechnique) {
    for (const scene::TechniqueInfo& info : scene::technique_catalogue()) {
        EXPECT_FALSE(missing_support(info.id, usual_tile, usual_limits())) << info.name;
        EXPECT_FALSE(missing_support(info.id, usual_terrain, usual_limits())) << info.name;
    }
}

TEST(TechniqueSupport, HeightsTooWideForATextureLeaveTriangles) {
    const DrawnSurface wide{false, {65536, 2}};
    for (const TechniqueId id : {TechniqueId::relief, TechniqueId::exact, TechniqueId::prewarp}) {
        const auto lack = missing_support(id, wide, usual_limits());
        ASSERT_TRUE(lack);
        EXPECT_THAT(*lack, HasSubstr("65536 x 2 samples found"));
        EXPECT_THAT(*lack, HasSubstr("at most 16384"));
    }
    EXPECT_FALSE(missing_support(TechniqueId::polygons, wide, usual_limits()));
    EXPECT_EQ(nearest_technique(TechniqueId::relief, wide, usual_limits()), TechniqueId::polygons);
}

// Its pyramid is as wide as the next power of two; the heights themselves are not.
TEST(TechniqueSupport, PyramidTooWideLeavesTheTechniqueBeforeExact) {
    gl::Limits limits = usual_limits();
    limits.max_texture_size = 1100;
    EXPECT_TRUE(missing_support(TechniqueId::exact, usual_terrain, limits));
    EXPECT_EQ(nearest_technique(TechniqueId::exact, usual_terrain, limits), TechniqueId::cone);
    EXPECT_FALSE(missing_support(TechniqueId::exact, {false, {1024, 1024}}, limits));
}

TEST(TechniqueSupport, FewTextureUnitsLeaveWhatTakesFewMaps) {
    gl::Limits limits = usual_limits();
    limits.max_fragment_texture_units = 6;
    EXPECT_THAT(*missing_support(TechniqueId::cone, usual_tile, limits),
                HasSubstr("6 texture units"));
    EXPECT_EQ(nearest_technique(TechniqueId::cone, usual_tile, limits), TechniqueId::pom);
    EXPECT_EQ(nearest_technique(TechniqueId::prewarp, usual_tile, limits),
              TechniqueId::multi_layer);
    EXPECT_FALSE(missing_support(TechniqueId::prewarp, usual_terrain, limits));
}

TEST(TechniqueSupport, OldOpenGlDrawsNothing) {
    for (const char* const version : {"3.2 (Core Profile)", "4.4.0 NVIDIA", "", "old"}) {
        gl::Limits limits = usual_limits();
        limits.version = version;
        EXPECT_THAT(*missing_support(TechniqueId::texture, usual_terrain, limits),
                    HasSubstr("4.5"));
        EXPECT_EQ(nearest_technique(TechniqueId::relief, usual_terrain, limits), std::nullopt);
    }
    gl::Limits newer = usual_limits();
    newer.version = "10.0";
    EXPECT_FALSE(missing_support(TechniqueId::texture, usual_terrain, newer));
}

TEST(TechniqueSupport, OneSentenceNamesWhatIsLackingAndWhatWorks) {
    scene::Scene scene;
    scene::Node& node = test::add_terrain(scene, test::plane_heightfield(Grid<float>(40, 3, 0.0F)));
    scene.add_camera(test::camera_at({0.0, -50.0, 30.0}, {0.0, 0.0, 0.0}));
    node.get<scene::TerrainNode>()->material.technique = scene::parse_technique("steep").value();
    gl::Limits limits = usual_limits();
    EXPECT_TRUE(check_support(view::select(scene, {64, 48}).list, limits));
    limits.max_texture_size = 32;
    const auto refused = check_support(view::select(scene, {64, 48}).list, limits);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().message,
              "technique steep: heights of 40 x 3 samples found, which take a texture 40 wide, at "
              "most 32 was expected; polygons works here");
}

} // namespace
} // namespace reljef::render
