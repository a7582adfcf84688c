#include "engine/scene/streaming/ground_overlay.h"

#include <memory>

#include <gtest/gtest.h>

#include "engine/scene/streaming/terrain_light.h"
#include "tests/scene/streaming/made_plane_tiles.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::scene {
namespace {

using namespace test::plane_tiles;

constexpr Rgba8 red{255, 0, 0, 255};
constexpr Rgba8 nothing{0, 255, 0, 0};

// The western half is red.
std::shared_ptr<const Image> half_red(int size) {
    Image colors(size, size, nothing);
    for (int row = 0; row < size; ++row) {
        for (int col = 0; 2 * col < size; ++col) {
            colors(col, row) = red;
        }
    }
    return std::make_shared<const Image>(std::move(colors));
}

std::shared_ptr<const TerrainSurface> with(const TerrainSurface& surface,
                                           std::shared_ptr<const Image> overlay) {
    TerrainOptions options = surface.options();
    options.overlay = std::move(overlay);
    auto changed = surface.changed(options);
    EXPECT_TRUE(changed);
    return std::make_shared<const TerrainSurface>(std::move(*changed));
}

TEST(GroundOverlay, LiesOverTheColoursOfATerrainInMemory) {
    const auto plain = overview();
    const Image before = albedo_map(*plain);
    for (const int size : {2, 33, before.cols(), 500}) { // coarser, equal and finer
        const auto colored = with(*plain, half_red(size));
        const Image after = albedo_map(*colored);
        const int last = after.cols() - 1;
        for (int row = 0; row < after.rows(); row += 8) {
            EXPECT_EQ(after(0, row), red) << size;
            EXPECT_EQ(after(last, row), before(last, row)) << size;
        }
    }
    EXPECT_EQ(albedo_map(*with(*plain, nullptr)), before);
}

TEST(GroundOverlay, BlendsByItsAlphaAndStaysWithOtherHeights) {
    const auto plain = overview();
    const Rgba8 before = albedo_map(*plain)(5, 5);
    const auto half =
        with(*plain, std::make_shared<const Image>(Image(2, 2, Rgba8{255, 0, 0, 128})));
    const Rgba8 after = albedo_map(*half)(5, 5);
    EXPECT_NEAR(after.r, 0.5 * (before.r + 255), 2.0);
    EXPECT_NEAR(after.g, 0.5 * before.g, 2.0);
    EXPECT_EQ(half->exaggerated(2.0)->overlay(), half->overlay());
}

TEST(GroundOverlay, LiesAtTheSamePlacesOfATileOfEachLevel) {
    const auto colored = with(*overview(), half_red(129));
    const TileBuilder make(colored, terrain::TileTree(side, side), reduction,
                           {.finest_pixel = 2.0, .refinement = 1});
    const TileBuilder plain = maker();
    for (const terrain::TreeTile west : {terrain::TreeTile{0, 3, 3}, {1, 1, 2}, {2, 0, 0}}) {
        const TerrainTile made = make.make(west, read_plane(west, {}).heights);
        EXPECT_EQ(made.albedo(10, 10), red) << west.level;
        const terrain::TreeTile east{west.level, west.col + (8 >> west.level), west.row};
        const TerrainTile other = make.make(east, read_plane(east, {}).heights);
        EXPECT_EQ(other.albedo(50, 10),
                  plain.make(east, read_plane(east, {}).heights).albedo(50, 10));
    }
    // The border of the colours is at the middle of the terrain.
    const terrain::TreeTile all{4, 0, 0};
    const TerrainTile whole = make.make(all, read_plane(all, {}).heights);
    const TerrainTile uncolored = plain.make(all, read_plane(all, {}).heights);
    const int middle = whole.cells.x / 2;
    for (int col = 0; col <= whole.cells.x; ++col) {
        if (col != middle) {
            EXPECT_EQ(whole.albedo(col, 20), col < middle ? red : uncolored.albedo(col, 20)) << col;
        }
    }
}

TEST(GroundOverlay, LiesOverThePictureOfATile) {
    const auto colored = with(*overview(), half_red(129));
    const TileBuilder make(colored, terrain::TileTree(side, side), reduction,
                           {.finest_pixel = 2.0, .refinement = 1});
    const terrain::TreeTile tile{0, 3, 3};
    const TilePicture picture{Image(257, 257, Rgba8{1, 2, 3, 255}), true, true};
    EXPECT_EQ(make.make(tile, read_plane(tile, {}).heights, picture).albedo(100, 100), red);
}

} // namespace
} // namespace reljef::scene
