#include "engine/terrain/field/tile_lattice.h"

#include <gtest/gtest.h>

#include "engine/terrain/field/placement.h"
#include "engine/terrain/tree/tile_tree.h"
#include "tests/terrain/chance.h"
#include "tests/terrain/made_bisection.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::terrain {
namespace {

TEST(TileLattice, HasTheSamplesOfTheTreeAlsoWhereTheRasterCutsTheLastCells) {
    test::Chance chance(3);
    for (int round = 0; round < 2000; ++round) {
        const TileTree tree(chance.whole(2, 5000), chance.whole(2, 5000));
        TreeTile id = tree.root();
        for (int i = chance.whole(0, id.level); i > 0; --i) {
            const auto children = tree.children(id);
            id = children[static_cast<std::size_t>(
                chance.whole(0, static_cast<int>(children.size()) - 1))];
        }
        const glm::ivec2 cells = tree.cells(id);
        const TileLattice lattice{glm::dvec2(TileTree::first(id)),
                                  glm::dvec2(tree.sample(id, cells)),
                                  static_cast<double>(TileTree::step(id)), cells};
        for (const glm::ivec2 vertex :
             {glm::ivec2(0), cells, cells - 1, glm::ivec2(cells.x / 2, cells.y)}) {
            const glm::dvec2 expected(tree.sample(id, vertex));
            ASSERT_EQ(lattice.on_terrain(glm::dvec2(vertex)), expected) << round;
            ASSERT_EQ(lattice.from_terrain(expected), glm::dvec2(vertex)) << round;
        }
        const glm::dvec2 any(chance.between(0.0, cells.x), chance.between(0.0, cells.y));
        const glm::dvec2 back = lattice.from_terrain(lattice.on_terrain(any));
        ASSERT_NEAR(back.x, any.x, 1e-9);
        ASSERT_NEAR(back.y, any.y, 1e-9);
    }
}

TEST(TileLattice, PlacesATileWhereTheOverviewHasItsSamples) {
    const Heightfield overview = test::plane_heightfield(test::rough_hills(40, 30, 5), {8.0, 8.0});
    const Placement whole = Placement::create(overview, PlacementKind::plane, 2.0).value();
    const Reduction reduction{4, {}, {}};
    const Placement tile = whole.of_tile(reduction, {{64.0, 32.0}, {100.0, 64.0}, 16.0, {3, 2}});
    for (const glm::dvec3 sample :
         {glm::dvec3(0.0, 0.0, 5.0), {1.5, 0.25, -3.0}, {3.0, 2.0, 1.0}}) {
        const double col = sample.x <= 2.0 ? 64.0 + 16.0 * sample.x : 96.0 + 4.0 * (sample.x - 2.0);
        const glm::dvec2 at = reduction.on_overview({col, 32.0 + 16.0 * sample.y});
        const glm::dvec3 expected = whole.world_from_sample({at, sample.z});
        const glm::dvec3 found = tile.world_from_sample(sample);
        EXPECT_EQ(found, expected);
        const glm::dvec3 back = tile.sample_from_world(found).value();
        EXPECT_NEAR(back.x, sample.x, 1e-12);
        EXPECT_NEAR(back.y, sample.y, 1e-12);
        EXPECT_NEAR(back.z, sample.z, 1e-12);
    }
}

} // namespace
} // namespace reljef::terrain
