#include "engine/session/objects/placed_buildings.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/truth/mesh_caster.h"
#include "tests/io/footprints/made_footprints.h"
#include "tests/session/objects/made_ground.h"
#include "tests/support/temporary_folder.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::session {
namespace {

using test::footprints_text;
using test::ground_of;
using test::polygon_feature;
using test::rectangle;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

// z = 100 + x / 10 over 200 m.
terrain::Heightfield gentle_slope() {
    return test::plane_heightfield(test::made_heights(
        201, 201, [](int col, int) { return 100.0F + 0.1F * static_cast<float>(col - 100); }));
}

class PlacedBuildingsTest : public testing::Test {
protected:
    io::FootprintsDescription footprints(const std::vector<std::string>& features,
                                         building::RoofKind roof = building::RoofKind::flat) {
        return {folder_.write("made.geojson", footprints_text(features)), "h", {}, roof};
    }
    Result<PlacedBuildings> place(const scene::TerrainSurface& surface,
                                  const io::FootprintsDescription& file,
                                  const SourceHeights& heights = {}) {
        return add_buildings(scene_, {surface, heights}, {file}, {});
    }
    // z of the highest face at x, y.
    std::optional<double> top_at(double x, double y) const {
        const auto caster = truth::MeshCaster::create(scene_).value();
        const Ray down{{x, y, 10'000.0}, {0.0, 0.0, -1.0}};
        const auto hit = caster.first_hit(down, {0.0, 20'000.0});
        return hit ? std::optional(down.at(hit->t).z) : std::nullopt;
    }

    test::TemporaryFolder folder_;
    scene::Scene scene_;
};

TEST_F(PlacedBuildingsTest, StandOnTheLowestGroundAtTheirOutline) {
    const auto placed = place(
        ground_of(gentle_slope()),
        footprints({polygon_feature("[" + rectangle(10.0, -5.0, 30.0, 5.0) + "]", "\"h\":12")}));
    ASSERT_TRUE(placed) << placed.error().message;
    EXPECT_TRUE(placed->notes.empty());
    const Box bounds = placed->node->world_bounds();
    EXPECT_NEAR(bounds.low.x, 10.0, 1e-4);
    EXPECT_NEAR(bounds.high.y, 5.0, 1e-4);
    EXPECT_NEAR(bounds.high.z, 101.0 + 12.0, 1e-4);
    EXPECT_NEAR(bounds.low.z, 101.0 - 1.0, 1e-4) << "a metre in the ground";
}

TEST_F(PlacedBuildingsTest, CourtyardsAreOpen) {
    const auto placed =
        place(ground_of(gentle_slope()),
              footprints({polygon_feature("[" + rectangle(-20.0, -20.0, 20.0, 20.0) + "," +
                                              rectangle(-10.0, -10.0, 10.0, 10.0) + "]",
                                          "\"h\":9")}));
    ASSERT_TRUE(placed);
    EXPECT_NEAR(top_at(-15.0, 0.0).value(), 98.0 + 9.0, 1e-4);
    EXPECT_FALSE(top_at(0.0, 0.0));
    EXPECT_FALSE(top_at(25.0, 0.0));
}

TEST_F(PlacedBuildingsTest, HippedRoofsRiseToTheHeight) {
    const auto placed =
        place(ground_of(gentle_slope()),
              footprints({polygon_feature("[" + rectangle(0.0, -5.0, 30.0, 5.0) + "]", "\"h\":12")},
                         building::RoofKind::hipped));
    ASSERT_TRUE(placed);
    EXPECT_NEAR(top_at(15.0, 0.0).value(), 112.0, 1e-4) << "the ridge";
    EXPECT_NEAR(top_at(15.0, 2.5).value(), 112.0 - 0.7 * 2.5, 1e-4);
    EXPECT_NEAR(top_at(1.0, 0.0).value(), 112.0 - 0.7 * 4.0, 1e-4);
}

TEST_F(PlacedBuildingsTest, ExaggerationLiftsTheGroundAndNotTheBuilding) {
    const auto placed = place(
        ground_of(gentle_slope(), 2.0),
        footprints({polygon_feature("[" + rectangle(0.0, -5.0, 30.0, 5.0) + "]", "\"h\":12")}));
    ASSERT_TRUE(placed);
    EXPECT_NEAR(placed->node->world_bounds().high.z, 212.0, 1e-4);
    const std::size_t children = placed->node->children().size();
    stand_on(ground_of(gentle_slope(), 3.0), *placed);
    EXPECT_NEAR(placed->node->world_bounds().high.z, 312.0, 1e-4);
    EXPECT_EQ(placed->node->children().size(), children);
}

TEST_F(PlacedBuildingsTest, StandUprightOnTheEarth) {
    const scene::TerrainSurface surface = ground_of(test::geographic_heightfield(
        Grid<float>(201, 201, 1000.0F), 46.0, 7.0, 0.01)); // to 44° north, 9° east
    const auto placed =
        place(surface, footprints({polygon_feature(
                           "[" + rectangle(8.5, 45.2, 8.5004, 45.2003) + "]", "\"h\":30")}));
    ASSERT_TRUE(placed);
    const auto& square = *placed->node->children().front();
    const auto& roof = *square.children().back()->get<scene::MeshNode>();
    const glm::dvec3 up = surface.placement().up(glm::dvec3(square.parent_from_local()[3]));
    EXPECT_NEAR(glm::dot(glm::dvec3(roof.mesh->normals[0]), up), 1.0, 1e-6);
    for (const glm::vec3 position : roof.mesh->positions) {
        const glm::dvec3 world(square.parent_from_local() * glm::dvec4(glm::dvec3(position), 1.0));
        const auto at = surface.placement().geodetic_from_world(world);
        ASSERT_TRUE(at);
        EXPECT_NEAR(at->height, 1030.0, 1e-2);
        EXPECT_NEAR(std::min(std::abs(at->longitude - 8.5), std::abs(at->longitude - 8.5004)), 0.0,
                    1e-7);
    }
}

TEST_F(PlacedBuildingsTest, WhatCannotStandIsLeftOutWithOneNote) {
    terrain::Heightfield with_void = gentle_slope();
    with_void.void_mask = Grid<std::uint8_t>(201, 201);
    with_void.void_mask(100, 100) = 1;
    with_void.void_count = 1;
    const auto square = [](double x, const char* height) {
        return polygon_feature("[" + rectangle(x, 20.0, x + 10.0, 30.0) + "]",
                               std::string("\"h\":") + height);
    };
    const auto placed = place(
        ground_of(with_void),
        footprints({square(-50.0, "9"), square(95.0, "9"), square(500.0, "9"), square(0.0, "-9"),
                    square(0.0, "null"),
                    polygon_feature("[" + rectangle(-0.5, -0.5, 5.5, 5.5) + "]", "\"h\":9")}));
    ASSERT_TRUE(placed);
    ASSERT_EQ(placed->notes.size(), 1U);
    EXPECT_THAT(placed->notes[0],
                AllOf(HasSubstr("2 not wholly on the terrain"), HasSubstr("1 over a void"),
                      HasSubstr("1 without a height"), HasSubstr("1 with a height that is not")));
    EXPECT_EQ(placed->buildings->size(), 1U);
}

TEST_F(PlacedBuildingsTest, AllLeftOutIsAnErrorWithTheReasons) {
    const auto placed = place(
        ground_of(gentle_slope()),
        footprints({polygon_feature("[" + rectangle(900.0, 0.0, 930.0, 5.0) + "]", "\"h\":12"),
                    polygon_feature("[" + rectangle(0.0, 0.0, 9.0, 5.0) + "]", "\"h\":-1")}));
    ASSERT_FALSE(placed);
    EXPECT_THAT(placed.error().message,
                AllOf(HasSubstr("1 not wholly on the terrain"),
                      HasSubstr("1 with a height that is not"),
                      HasSubstr("; no building is left, some were expected")));
}

TEST_F(PlacedBuildingsTest, FlatRoofsInsteadOfHippedOnesAreCounted) {
    const std::string corner = "[[0,0],[30,0],[30,10],[10,10],[10,30],[0,30],[0,0]]";
    io::FootprintsDescription file =
        footprints({polygon_feature("[" + corner + "]", "\"h\":9"),
                    polygon_feature("[" + rectangle(50.0, 0.0, 60.0, 20.0) + "]", "\"h\":9")});
    const auto flat = place(ground_of(gentle_slope()), file);
    file.roof = building::RoofKind::hipped;
    const auto hipped = place(ground_of(gentle_slope()), file);
    ASSERT_TRUE(flat && hipped);
    EXPECT_THAT(flat->notes, testing::IsEmpty());
    EXPECT_THAT(hipped->notes,
                testing::ElementsAre(HasSubstr("1 of 2 with roof=hipped have flat")));
}

TEST_F(PlacedBuildingsTest, FarBuildingsAreMeshesOfTheirOwn) {
    const auto placed = place(
        ground_of(test::plane_heightfield(Grid<float>(101, 101, 5.0F), {20.0, 20.0})),
        footprints({polygon_feature("[" + rectangle(-800.0, 0.0, -790.0, 9.0) + "]", "\"h\":9"),
                    polygon_feature("[" + rectangle(800.0, 0.0, 810.0, 9.0) + "]", "\"h\":9"),
                    polygon_feature("[" + rectangle(820.0, 0.0, 830.0, 9.0) + "]", "\"h\":9")}));
    ASSERT_TRUE(placed);
    EXPECT_EQ(placed->node->children().size(), 2U);
}

TEST_F(PlacedBuildingsTest, TheSourcesHeightsCountWhereThereAreSome) {
    const scene::TerrainSurface surface =
        ground_of(test::geographic_heightfield(Grid<float>(11, 11, 0.0F), 46.0, 7.0, 0.01));
    const auto file = footprints(
        {polygon_feature("[" + rectangle(7.05, 45.95, 7.0501, 45.9501) + "]", "\"h\":5")});
    const auto placed = place(surface, file, [](std::span<const glm::dvec2> places) {
        for (const glm::dvec2 place : places) {
            EXPECT_NEAR(place.x, 45.95, 0.001) << "a latitude";
        }
        return std::vector<std::optional<double>>(places.size(), 70.0);
    });
    ASSERT_TRUE(placed);
    EXPECT_EQ(placed->buildings->front().ground, 70.0);
    const auto voids = place(surface, file, [](std::span<const glm::dvec2> places) {
        return std::vector<std::optional<double>>(places.size());
    });
    ASSERT_FALSE(voids);
    EXPECT_THAT(voids.error().message, HasSubstr("1 over a void; no building is left"));
}

TEST_F(PlacedBuildingsTest, RoofsLieOnTheMedianOfTheSurfaceModel) {
    const scene::TerrainSurface surface =
        ground_of(test::geographic_heightfield(Grid<float>(101, 101, 10.0F), 46.0, 7.0, 0.0001));
    // 25 m high within the outline, with a tower of 80 m and a hole of 0 m on less than half of it.
    std::string text = "ncols 101\nnrows 101\nxllcenter 7\nyllcenter 45.99\ncellsize 0.0001\n";
    for (int row = 0; row < 101; ++row) {
        for (int col = 0; col < 101; ++col) {
            const bool inside = col >= 40 && col <= 60 && row >= 40 && row <= 60;
            text += !inside ? "10 " : col < 45 ? "80 " : col > 55 ? "0 " : "25 ";
        }
        text += "\n";
    }
    const auto model = folder_.write("surface.asc", text);
    folder_.write("surface.prj",
                  R"(GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],)"
                  R"(PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]])");
    io::FootprintsDescription file =
        footprints({polygon_feature("[" + rectangle(7.004, 45.994, 7.006, 45.996) + "]")});
    file.height.clear();
    file.surface = model;
    const auto placed = place(surface, file);
    ASSERT_TRUE(placed) << placed.error().message;
    ASSERT_NE(placed->node, nullptr);
    EXPECT_NEAR(placed->buildings->front().height, 15.0, 1e-3);
    const auto plane = place(ground_of(gentle_slope()), file);
    ASSERT_FALSE(plane);
    EXPECT_THAT(plane.error().message, HasSubstr("is not georeferenced"));
}

} // namespace
} // namespace reljef::session
