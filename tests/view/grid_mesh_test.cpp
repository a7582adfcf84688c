#include "engine/view/grid_mesh.h"

#include <cstring>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/terrain/made_heightfield.h"

namespace reljef::render {
namespace {

glm::dvec3 local_place(const view::GridVertex& vertex) {
    return glm::dvec3(vertex.position) + glm::dvec3(vertex.rest);
}

terrain::Placement placed(const terrain::Heightfield& heightfield) {
    const auto kind = heightfield.georeference ? terrain::PlacementKind::ellipsoid
                                               : terrain::PlacementKind::plane;
    return terrain::Placement::create(heightfield, kind, 2.0).value();
}

TEST(GridMesh, EverySampleIsAVertexInItsPlace) {
    for (const terrain::Heightfield& heightfield :
         {test::plane_heightfield(test::random_heights(150, 140, -50.0F, 900.0F, 1), {30.0, 31.0}),
          test::geographic_heightfield(test::random_heights(150, 140, -50.0F, 900.0F, 2), 46.0, 7.0,
                                       1.0 / 1200.0)}) {
        const terrain::Placement placement = placed(heightfield);
        for (const terrain::TileCells& tile : terrain::tile_layout(test::cells_of(heightfield))) {
            const view::GridMesh mesh = view::full_mesh(heightfield, placement, tile);
            ASSERT_EQ(mesh.cols, tile.count.x);
            ASSERT_EQ(mesh.rows, tile.count.y);
            for (int row = 0; row <= tile.count.y; ++row) {
                for (int col = 0; col <= tile.count.x; ++col) {
                    const view::GridVertex& vertex =
                        mesh.vertices[static_cast<std::size_t>(row * (tile.count.x + 1) + col)];
                    const float height =
                        heightfield.heights(tile.first.x + col, tile.first.y + row);
                    ASSERT_EQ(vertex.height, height);
                    const glm::dvec3 world = placement.world_from_sample(
                        {tile.first.x + col, tile.first.y + row, height});
                    ASSERT_LE(glm::distance(local_place(vertex), world), 1e-8);
                }
            }
        }
    }
}

TEST(GridMesh, AFlatTileOnAPlaneIsOneQuadAtItsHeight) {
    const auto heightfield = test::plane_heightfield(Grid<float>(150, 140, 0.0F), {2.0, 3.0});
    const terrain::Placement placement = placed(heightfield);
    for (const terrain::TileCells& tile : terrain::tile_layout(test::cells_of(heightfield))) {
        const view::GridMesh mesh = view::flat_mesh(placement, tile, 10.0);
        ASSERT_EQ(mesh.vertices.size(), 4U);
        EXPECT_EQ(local_place(mesh.vertices[0]),
                  placement.world_from_sample({tile.first.x, tile.first.y, 10.0}));
        EXPECT_EQ(local_place(mesh.vertices[3]),
                  placement.world_from_sample({tile.last().x, tile.last().y, 10.0}));
    }
}

TEST(GridMesh, AFlatTileOnAnEllipsoidFollowsTheEarth) {
    const auto heightfield =
        test::geographic_heightfield(Grid<float>(129, 129, 0.0F), 46.0, 7.0, 1.0 / 1200.0);
    const terrain::Placement placement = placed(heightfield);
    const auto tiles = terrain::tile_layout(test::cells_of(heightfield));
    const view::GridMesh mesh = view::flat_mesh(placement, tiles.front(), 100.0);
    EXPECT_EQ(mesh.vertices.size(), static_cast<std::size_t>((mesh.cols + 1) * (mesh.rows + 1)));
    for (const view::GridVertex& vertex : mesh.vertices) {
        const auto sample = placement.sample_from_world(local_place(vertex));
        ASSERT_TRUE(sample);
        EXPECT_NEAR(sample->z, 100.0, 1e-3);
        EXPECT_EQ(vertex.height, 100.0F);
    }
}

TEST(GridMesh, NeighboursHaveTheSameBitsForAVertexTheyShare) {
    const auto heightfield = test::geographic_heightfield(
        test::random_heights(300, 140, -50.0F, 900.0F, 2), 46.0, 7.0, 1.0 / 1200.0);
    const terrain::Placement placement = placed(heightfield);
    const auto tiles = terrain::tile_layout(test::cells_of(heightfield));
    const view::GridMesh west = view::full_mesh(heightfield, placement, tiles[0]);
    const view::GridMesh east = view::full_mesh(heightfield, placement, tiles[1]);
    const terrain::Triangulation border{{terrain::steps_of({terrain::tile_cells, 7})}, {}};
    const auto cut = view::VertexPlacer(heightfield, placement, tiles[1]).place(border);
    for (int row = 0; row <= west.rows; ++row) {
        const view::GridVertex& a =
            west.vertices[static_cast<std::size_t>(row * (west.cols + 1) + west.cols)];
        const view::GridVertex& b = east.vertices[static_cast<std::size_t>(row * (east.cols + 1))];
        ASSERT_EQ(a.position, b.position);
        ASSERT_EQ(a.rest, b.rest);
        if (row == 7) {
            EXPECT_EQ(a.position, cut.front().position);
            EXPECT_EQ(a.rest, cut.front().rest);
        }
    }
}

TEST(GridMesh, KnownVerticesHaveTheBitsOfNewOnes) {
    std::mt19937 random(11);
    const auto heightfield = test::geographic_heightfield(
        test::random_heights(300, 140, -50.0F, 900.0F, 2), 46.0, 7.0, 1.0 / 1200.0);
    const terrain::Placement placement = placed(heightfield);
    for (const terrain::TileCells& tile : terrain::tile_layout(test::cells_of(heightfield))) {
        const auto chance_part = [&] {
            terrain::Triangulation part;
            for (int i = 0; i < 2000; ++i) {
                // Every second one at a sample.
                const int scale = i % 2 == 0 ? terrain::steps_per_sample : 1;
                const glm::ivec2 most(terrain::steps_per_sample / scale * tile.count);
                const glm::ivec2 place(std::uniform_int_distribution(0, most.x)(random),
                                       std::uniform_int_distribution(0, most.y)(random));
                part.vertices.push_back(terrain::steps_of(tile.first) +
                                        terrain::Steps(scale * place));
            }
            return part;
        };
        const view::VertexPlacer fresh(heightfield, placement, tile);
        view::VertexPlacer knowing(heightfield, placement, tile);
        const terrain::Triangulation before = chance_part();
        const auto known = fresh.place(before);
        knowing.know(before, known);
        for (const terrain::Triangulation& part : {before, chance_part(), chance_part()}) {
            const auto expected = fresh.place(part);
            const auto found = knowing.place(part);
            ASSERT_EQ(found.size(), expected.size());
            ASSERT_EQ(std::memcmp(found.data(), expected.data(),
                                  expected.size() * sizeof(view::GridVertex)),
                      0);
        }
    }
}

} // namespace
} // namespace reljef::render
