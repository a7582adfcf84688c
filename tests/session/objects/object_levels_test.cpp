// Objects with many triangles have levels of detail where the ground keeps an error bound.
#include <gtest/gtest.h>

#include "engine/session/objects/object_levels.h"
#include "tests/io/mesh/made_mesh.h"
#include "tests/session/made_session.h"
#include "tests/support/temporary_folder.h"

namespace reljef::session {
namespace {

class ObjectLevels : public testing::Test {
protected:
    Result<TerrainScene> open(const std::string& technique, int rings, bool mesh_levels = true) {
        SourceOptions source;
        source.terrain = folder_
                             .write("dem.asc", "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\n"
                                               "cellsize 900\n0 0 0\n0 0 0\n0 0 0\n")
                             .string();
        SceneOptions view;
        view.technique = scene::parse_technique(technique).value();
        view.mesh_levels = mesh_levels;
        view.objects = {{folder_.write("ball.obj", test::ball_obj(rings)), glm::dvec2(1.0, 2.0)}};
        Log silent;
        return open_scene(source, view, silent);
    }
    static const scene::MeshNode& part_of(const TerrainScene& scene) {
        return *scene.objects.front().node->children().front()->get<scene::MeshNode>();
    }

    test::TemporaryFolder folder_;
};

TEST_F(ObjectLevels, AreMadeForTechniquesWithAnErrorBound) {
    const auto scene = open("polygons:error=1", 40);
    ASSERT_TRUE(scene) << scene.error().message;
    const scene::MeshNode& part = part_of(*scene);
    ASSERT_NE(part.levels, nullptr);
    ASSERT_GE(part.levels->size(), 2U);
    EXPECT_TRUE(meshes_without_levels(scene->objects).empty()) << "once";
}

TEST_F(ObjectLevels, AreNotPaidForWithoutABoundOrForFewTriangles) {
    const auto exact = open("exact", 40);
    ASSERT_TRUE(exact) << exact.error().message;
    EXPECT_EQ(part_of(*exact).levels, nullptr);
    EXPECT_EQ(meshes_without_levels(exact->objects).size(), 1U) << "of a technique chosen later";
    const auto small = open("polygons:error=1", 20);
    ASSERT_TRUE(small) << small.error().message;
    EXPECT_EQ(part_of(*small).levels, nullptr);
    const auto one_picture = open("polygons:error=1", 40, false);
    ASSERT_TRUE(one_picture) << one_picture.error().message;
    EXPECT_EQ(part_of(*one_picture).levels, nullptr);
}

} // namespace
} // namespace reljef::session
