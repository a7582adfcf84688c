#include "engine/terrain/field/tile_lattice.h"

#include <cmath>

#include <glm/common.hpp>
#include <gtest/gtest.h>

#include "engine/terrain/field/placement.h"
#include "engine/terrain/tree/tile_tree.h"
#include "tests/terrain/chance.h"
#include "tests/terrain/made_bisection.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::terrain {
namespace {

void expect_near(glm::dvec2 found, glm::dvec2 expected, double error) {
    EXPECT_LE(std::abs(found.x - expected.x), error);
    EXPECT_LE(std::abs(found.y - expected.y), error);
}

/// Of a tree, by chance.
TreeTile some_tile(const TileTree& tree, test::Chance& chance) {
    TreeTile id = tree.root();
    for (int i = chance.whole(0, id.level); i > 0; --i) {
        const auto children = tree.children(id);
        id = children[static_cast<std::size_t>(
            chance.whole(0, static_cast<int>(children.size()) - 1))];
    }
    return id;
}

/// Within a cell.
void expect_even_latitudes(const TileLattice& lattice, int cell) {
    const auto latitude = [&](double row) {
        return lattice.rows.source_row(lattice.on_terrain({0.0, row}).y);
    };
    ASSERT_NEAR(latitude(cell + 0.25), glm::mix(latitude(cell), latitude(cell + 1.0), 0.25), 1e-9);
    ASSERT_NEAR(lattice.on_even_rows({0.0, cell + 0.5}).y,
                latitude(cell + 0.5) + lattice.rows.wrap().north_rows(), 1e-9);
}

TEST(TileLattice, HasTheSamplesOfTheTreeAlsoWhereTheRasterCutsTheLastCells) {
    test::Chance chance(3);
    for (int round = 0; round < 2000; ++round) {
        const glm::ivec2 size(chance.whole(2, 5000), chance.whole(4, 5000));
        const geo::GlobalWrap wrap{.around = true,
                                   .north = chance.one_in(2) ? chance.between(0.01, 1.0) : 0.0,
                                   .south = chance.one_in(2) ? chance.between(0.01, 1.0) : 0.0};
        const TileTree tree(size.x, size.y, wrap);
        const TreeTile id = some_tile(tree, chance);
        const glm::ivec2 cells = tree.cells(id);
        const TileLattice lattice{glm::dvec2(TileTree::first(id)),
                                  glm::dvec2(tree.sample(id, cells)),
                                  static_cast<double>(TileTree::step(id)),
                                  cells,
                                  {wrap, size.y - wrap.rows()}};
        for (const glm::ivec2 vertex :
             {glm::ivec2(0), cells, cells - 1, glm::ivec2(cells.x / 2, cells.y)}) {
            const glm::dvec2 expected(tree.sample(id, vertex));
            expect_near(lattice.on_terrain(glm::dvec2(vertex)), expected,
                        wrap.rows() > 0 ? 1e-9 : 0.0);
            expect_near(lattice.from_terrain(expected), glm::dvec2(vertex),
                        wrap.rows() > 0 ? 1e-9 : 0.0);
        }
        expect_even_latitudes(lattice, chance.one_in(2) ? 0 : cells.y - 1);
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
