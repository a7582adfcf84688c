#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/session/gallery.h"
#include "tests/io/mesh/made_mesh.h"
#include "tests/session/made_session.h"
#include "tests/support/temporary_folder.h"

namespace reljef::session {
namespace {

class GalleryObject : public testing::Test {
protected:
    Result<TerrainScene> gallery_with(const std::filesystem::path& file) {
        SourceOptions options;
        options.terrain = "gallery";
        SceneOptions view;
        view.objects = {{file, {}}};
        auto source = test::open_terrain(options);
        return source ? test::make_scene(std::move(*source), options, view) : source.error();
    }

    test::TemporaryFolder folder_;
};

TEST_F(GalleryObject, IsShownOnceWithEachTechniqueInsteadOfTheShapes) {
    const auto scene = gallery_with(folder_.write("square.obj", test::square_obj));
    ASSERT_TRUE(scene) << scene.error().message;
    const auto catalogue = scene::technique_catalogue();
    const auto expected =
        std::count_if(catalogue.begin(), catalogue.end(), [](const scene::TechniqueInfo& info) {
            return scene::draws_any_mesh(info.id);
        });
    EXPECT_EQ(std::ssize(scene->models), expected);
    EXPECT_THAT(scene->objects, testing::IsEmpty());
    Box all;
    for (const scene::Node* const model : scene->models) {
        const auto& node = *model->get<scene::MeshNode>();
        EXPECT_EQ(scene::technique_info(node.material.technique.id()).name, model->name());
        const Box bounds =
            reljef::transformed(model->world_from_local(), scene::bounds_of(*node.mesh));
        EXPECT_NEAR(bounds.low.z, 0.0, 1e-6);
        EXPECT_NEAR(bounds.size().z, 1.1, 1e-6) << "its largest side";
        const Box apart{bounds.low - 0.1, bounds.high + 0.1};
        EXPECT_TRUE(all.empty() || apart.high.x < all.low.x || apart.low.x > all.high.x ||
                    apart.low.y > all.low.y);
        all = bounds;
    }
}

TEST_F(GalleryObject, NeedsTextureCoordinates) {
    const auto refused = gallery_with(folder_.write("cube.obj", test::cube_obj));
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message, testing::HasSubstr("no texture coordinates found"));
}

TEST(Gallery, TheFloorShowsShadowsIfAModelHasSome) {
    SourceOptions options;
    options.terrain = "gallery";
    const auto gallery_with = [&](std::string_view technique) {
        SceneOptions view;
        view.technique = scene::parse_technique(technique).value();
        return test::make_scene(test::open_terrain(options).value(), options, view).value();
    };
    const auto has_shadows = [](const TerrainScene& scene) {
        const auto& floor = *scene.terrain->get<scene::TerrainNode>();
        return floor.material.technique.options.shadow.has_value();
    };
    EXPECT_FALSE(has_shadows(gallery_with("relief")));
    const TerrainScene scene = gallery_with("relief:shadow=hard");
    EXPECT_TRUE(has_shadows(scene));
    auto& floor = *scene.terrain->get<scene::TerrainNode>();
    for (scene::Node* const model : scene.models) {
        EXPECT_TRUE(has_shadows(scene));
        model->get<scene::MeshNode>()->material.technique.options.shadow.reset();
        shadow_floor(floor, scene.models);
    }
    EXPECT_FALSE(has_shadows(scene));
}

} // namespace
} // namespace reljef::session
