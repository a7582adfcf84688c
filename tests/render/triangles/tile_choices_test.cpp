#include <array>
#include <set>

#include <glm/trigonometric.hpp>

#include "tests/render/triangles/streamed_world.h"
#include "tests/terrain/chance.h"

namespace reljef::render {
namespace {

TEST(TileChoices, DrawTheRootUntilFinerTilesAreThere) {
    const StreamedWorld world;
    EXPECT_TRUE(world.choice().drawn.empty());
    EXPECT_EQ(world.choice().requested, std::vector{world.stream->tree().root()});
    world.request();
    world.stream->wait({});
    ASSERT_EQ(world.choice().drawn.size(), 1U);
    EXPECT_EQ(world.choice().drawn.front().tile->id, world.stream->tree().root());
    EXPECT_FALSE(world.choice().requested.empty());
}

TEST(TileChoices, NoneOverlapsAndNoneIsSeenCoarserThanTheErrorAllows) {
    StreamedWorld world;
    test::Chance chance(3);
    for (int round = 0; round < 25; ++round) {
        const glm::dvec3 eye(chance.between(-700, 700), chance.between(-700, 700),
                             chance.between(60, 900));
        world.look(eye, {chance.between(-700, 700), chance.between(-700, 700), 0.0});
        world.bring();
        std::set<TreeTile> drawn;
        const view::TileSelection choice = world.choice();
        for (const auto& [tile, distance, error, error_with_hidden] : choice.drawn) {
            drawn.insert(tile->id);
            const double pixels = 0.5 * size.y / std::tan(glm::radians(0.5 * 57.3));
            const double spacing = world.stream->maker().spacing(tile->id.level);
            if (tile->id.level > 0) {
                ASSERT_LE(spacing / view::samples_apart_in_errors * pixels / distance, 1.0 + 1e-9);
                ASSERT_LE(tile->error * pixels / distance, 0.5 + 1e-9);
            }
        }
        for (TreeTile tile : drawn) {
            while (tile.level < world.stream->tree().root().level) {
                tile = {tile.level + 1, tile.col / 2, tile.row / 2};
                ASSERT_FALSE(drawn.contains(tile));
            }
        }
    }
}

TEST(TileChoices, DrawNoMoreThanMemoryHolds) {
    StreamedWorld world(160);
    test::Chance chance(4);
    for (int round = 0; round < 20; ++round) {
        world.look({chance.between(-700, 700), chance.between(-700, 700), 50.0},
                   {chance.between(-700, 700), chance.between(-700, 700), 0.0});
        world.bring();
        ASSERT_LE(world.choice().drawn.size(), world.stream->max_drawn());
        ASSERT_LE(world.stream->stats().bytes, 176 * scene::bytes_per_tile);
    }
}

// Tiles that turned out to be too many go, and are not read again to find that out.
TEST(TileChoices, WhereMemoryLimitsAStillViewReadsNothingMore) {
    for (const std::size_t tiles : {1U, 12U, 24U, 40U}) {
        StreamedWorld world(tiles);
        world.look({0.0, -200.0, 120.0}, {0.0, 0.0, 0.0});
        const auto look_on = [&](int frames) {
            for (int i = 0; i < frames; ++i) {
                world.request();
                world.stream->wait({});
            }
            return world.stream->stats().read;
        };
        const int read = look_on(30);
        EXPECT_EQ(look_on(10), read) << tiles;
        EXPECT_TRUE(world.choice().requested.empty()) << tiles;
        EXPECT_LE(read, 100) << tiles;
    }
}

TEST(TileChoices, WhereMemoryLimitsTheChoiceIsTheSameWhateverCameBefore) {
    test::Chance chance(5);
    StreamedWorld flown(24);
    for (int round = 0; round < 8; ++round) {
        const StreamedWorld fresh(24);
        const glm::dvec3 eye(chance.between(-700, 700), chance.between(-700, 700), 60.0);
        flown.look(eye, {chance.between(-700, 700), chance.between(-700, 700), 0.0});
        *fresh.camera->get<Camera>() = *flown.camera->get<Camera>();
        flown.bring();
        fresh.bring();
        std::vector<TreeTile> expected;
        for (const view::TileSelection::Drawn& drawn : fresh.choice().drawn) {
            expected.push_back(drawn.tile->id);
        }
        std::vector<TreeTile> found;
        for (const view::TileSelection::Drawn& drawn : flown.choice().drawn) {
            found.push_back(drawn.tile->id);
        }
        ASSERT_EQ(found, expected) << round;
        ASSERT_GT(expected.size(), 4U);
    }
    EXPECT_GT(flown.stream->stats().evicted, 0);
}

} // namespace
} // namespace reljef::render
