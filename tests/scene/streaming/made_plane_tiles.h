#pragma once

#include <memory>
#include <stop_token>
#include <vector>

#include <gtest/gtest.h>

#include "engine/scene/streaming/tile_stream.h"
#include "tests/terrain/made_tiles.h"

/// A terrain that is a plane, read tile by tile.
namespace reljef::test::plane_tiles {

constexpr int side = 1025; // samples of the raster, 10 m apart
constexpr int reduction = 8;

inline double height_of(glm::dvec2 sample) {
    return 0.25 * sample.x - 0.5 * sample.y + 3.0;
}

inline std::shared_ptr<const scene::TerrainSurface> overview() {
    auto heightfield = plane_heightfield(overview_heights(side, reduction, height_of));
    heightfield.spacing = glm::dvec2(10.0 * reduction);
    auto surface = scene::TerrainSurface::create(std::make_shared<const terrain::Terrain>(
        terrain::Terrain{"made", std::move(heightfield), {}, {}}));
    EXPECT_TRUE(surface);
    return std::make_shared<const scene::TerrainSurface>(std::move(*surface));
}

inline scene::TileContent read_plane(terrain::TreeTile tile, const std::stop_token& /*stop*/) {
    const terrain::TileTree tree(side, side);
    scene::TileContent reading;
    reading.heights = tile_heights(tree.cells(tile), [&](glm::ivec2 vertex) {
        return height_of(glm::dvec2(tree.sample(tile, vertex)));
    });
    return reading;
}

inline scene::TileBuilder maker() {
    return {overview(), terrain::TileTree(side, side), reduction};
}

inline std::vector<terrain::TreeTile> level_0() {
    std::vector<terrain::TreeTile> tiles;
    for (int i = 0; i < 64; ++i) {
        tiles.push_back({0, i % 8, i / 8});
    }
    return tiles;
}

} // namespace reljef::test::plane_tiles
