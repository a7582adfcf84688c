#include "engine/session/objects/placed_objects.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/io/mesh/made_mesh.h"
#include "tests/session/objects/made_ground.h"
#include "tests/support/temporary_folder.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::session {
namespace {

using test::ground_of;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

// z = 3 x + 100 over 20 m.
terrain::Heightfield slope() {
    return test::plane_heightfield(test::made_heights(
        21, 21, [](int col, int) { return 100.0F + 3.0F * static_cast<float>(col - 10); }));
}

class PlacedObjectsTest : public testing::Test {
protected:
    io::ObjectDescription cube(glm::dvec2 at) const { return {cube_, at}; }
    Result<PlacedObjects> place(const scene::TerrainSurface& surface,
                                const std::vector<io::ObjectDescription>& objects,
                                const SourceHeight& height = {}) {
        return add_objects(scene_, surface, objects, height, {});
    }

    test::TemporaryFolder folder_;
    std::filesystem::path cube_ = folder_.write("cube.obj", test::cube_obj);
    scene::Scene scene_;
};

TEST_F(PlacedObjectsTest, StandOnTheExactGround) {
    const scene::TerrainSurface surface = ground_of(slope());
    io::ObjectDescription raised = cube({-2.5, 4.0});
    raised.height = 7.0;
    raised.scale = 3.0;
    const auto placed = place(surface, {cube({1.25, 0.5}), raised});
    ASSERT_TRUE(placed) << placed.error().message;
    const Box on_ground = placed->objects[0].node->world_bounds();
    EXPECT_NEAR(on_ground.low.z, 103.75, 1e-5);
    EXPECT_NEAR(on_ground.high.z, 105.75, 1e-5);
    EXPECT_NEAR(on_ground.low.x, 0.25, 1e-5);
    EXPECT_NEAR(on_ground.high.y, 1.5, 1e-5);
    const Box above = placed->objects[1].node->world_bounds();
    EXPECT_NEAR(above.low.z, 99.5, 1e-5);
    EXPECT_NEAR(above.high.z, 105.5, 1e-5);
    EXPECT_NEAR(above.low.x, -5.5, 1e-5);
}

TEST_F(PlacedObjectsTest, ObjectsThatShowNothingAreNoted) {
    const scene::TerrainSurface surface = ground_of(slope());
    const auto far = folder_.write("far.obj", "v 500 0 0\nv 501 0 0\nv 500 1 0\nf 1 2 3\n");
    const auto thin = folder_.write("thin.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    io::ObjectDescription deep = cube({2.0, 2.0});
    deep.height = -5.0;
    io::ObjectDescription half = deep;
    half.height = -1.5;
    const auto placed =
        place(surface, {{far, glm::dvec2(0.0)}, {thin, glm::dvec2(0.0)}, deep, half});
    ASSERT_TRUE(placed) << placed.error().message;
    EXPECT_EQ(placed->objects.size(), 4U);
    EXPECT_THAT(placed->notes,
                testing::ElementsAre(AllOf(StartsWith(far.string()), HasSubstr("outside")),
                                     AllOf(StartsWith(thin.string()), HasSubstr("no area")),
                                     HasSubstr("its top lies 3 m below the ground")));
}

TEST_F(PlacedObjectsTest, HeadingsTurnClockwiseFromNorth) {
    const scene::TerrainSurface surface = ground_of(slope());
    PlacedObject object{nullptr, cube({0.0, 0.0}), 0.0, {}};
    object.description.heading = 90.0;
    const glm::dmat4 turned = scene_from_object(surface, object).value();
    EXPECT_LT(glm::distance(glm::dvec3(turned[1]), glm::dvec3(1.0, 0.0, 0.0)), 1e-12)
        << "y points east";
    EXPECT_LT(glm::distance(glm::dvec3(turned[0]), glm::dvec3(0.0, -1.0, 0.0)), 1e-12);
    EXPECT_LT(glm::distance(glm::dvec3(turned[2]), glm::dvec3(0.0, 0.0, 1.0)), 1e-12);
}

TEST_F(PlacedObjectsTest, StandUprightAtLatitudeAndLongitude) {
    const scene::TerrainSurface surface = ground_of(test::geographic_heightfield(
        Grid<float>(201, 201, 1000.0F), 46.0, 7.0, 0.01)); // to 44° north, 9° east
    io::ObjectDescription described = cube({45.25, 8.5});
    described.heading = 30.0;
    const PlacedObject object{nullptr, described, 0.0, {}};
    const auto place = scene_from_object(surface, object);
    ASSERT_TRUE(place) << place.error().message;
    const glm::dvec3 origin((*place)[3]);
    const auto at = surface.placement().geodetic_from_world(origin);
    ASSERT_TRUE(at);
    EXPECT_NEAR(at->latitude, 45.25, 1e-9);
    EXPECT_NEAR(at->longitude, 8.5, 1e-9);
    EXPECT_NEAR(at->height, 1000.0, 1e-3);
    const glm::dvec3 up = surface.placement().up(origin);
    const glm::dvec3 north = surface.placement().north(origin);
    EXPECT_NEAR(glm::dot(glm::dvec3((*place)[2]), up), 1.0, 1e-12);
    EXPECT_NEAR(glm::dot(glm::dvec3((*place)[1]), north), std::cos(glm::radians(30.0)), 1e-12);
    EXPECT_NEAR(glm::dot(glm::dvec3((*place)[0]), north), -std::sin(glm::radians(30.0)), 1e-12);
}

TEST_F(PlacedObjectsTest, ExaggerationLiftsTheGroundAndNotTheObject) {
    const auto placed = place(ground_of(slope(), 2.0), {cube({0.0, 0.0})});
    ASSERT_TRUE(placed);
    EXPECT_NEAR(placed->objects[0].node->world_bounds().low.z, 200.0, 1e-4);
    EXPECT_NEAR(placed->objects[0].node->world_bounds().high.z, 202.0, 1e-4);
    stand_on(ground_of(slope(), 3.0), placed->objects);
    EXPECT_NEAR(placed->objects[0].node->world_bounds().low.z, 300.0, 1e-4);
}

TEST_F(PlacedObjectsTest, InstancesShareTheirMesh) {
    const auto placed = place(ground_of(slope()), {cube({0.0, 0.0}), cube({5.0, 5.0})});
    ASSERT_TRUE(placed);
    const auto mesh_of = [&](std::size_t i) {
        return placed->objects[i].node->children().front()->get<scene::MeshNode>()->mesh;
    };
    EXPECT_EQ(mesh_of(0), mesh_of(1));
}

TEST_F(PlacedObjectsTest, TheSourcesHeightCountsWhereThereIsOne) {
    const scene::TerrainSurface surface = ground_of(slope());
    const auto placed =
        place(surface, {cube({0.0, 0.0})}, [](glm::dvec2) { return std::optional(42.0); });
    ASSERT_TRUE(placed);
    EXPECT_NEAR(placed->objects[0].node->world_bounds().low.z, 42.0, 1e-5);
    EXPECT_FALSE(
        place(surface, {cube({0.0, 0.0})}, [](glm::dvec2) { return std::optional<double>(); }));
}

TEST_F(PlacedObjectsTest, RefusesPlacesWithoutGroundInOneSentence) {
    const auto refusal = [&](const scene::TerrainSurface& surface, glm::dvec2 at) {
        const auto refused = place(surface, {cube(at)});
        EXPECT_FALSE(refused);
        return refused ? "" : refused.error().message;
    };
    const scene::TerrainSurface plane = ground_of(slope());
    EXPECT_THAT(refusal(plane, {10.1, 0.0}),
                AllOf(StartsWith(cube_.string()), HasSubstr("outside the terrain"),
                      HasSubstr("on made was expected")));
    const scene::TerrainSurface earth =
        ground_of(test::geographic_heightfield(Grid<float>(11, 11, 0.0F), 46.0, 7.0, 0.01));
    EXPECT_THAT(refusal(earth, {10.0, 7.05}), HasSubstr("outside the terrain"));
    EXPECT_THAT(refusal(earth, {100.0, 7.05}), HasSubstr("no place on Earth"));
    terrain::Heightfield with_void = slope();
    with_void.void_mask = Grid<std::uint8_t>(21, 21);
    with_void.void_mask(10, 10) = 1;
    with_void.void_count = 1;
    EXPECT_THAT(refusal(ground_of(with_void), {0.5, 0.5}), HasSubstr("a void"));
    io::ObjectDescription nowhere{cube_, {}};
    const auto refused = place(plane, {nowhere});
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message, HasSubstr("no place found"));
}

} // namespace
} // namespace reljef::session
