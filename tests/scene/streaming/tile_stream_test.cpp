#include "engine/scene/streaming/tile_stream.h"

#include <array>
#include <atomic>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/parallel_for.h"
#include "engine/scene/graph/terrain_node.h"
#include "tests/scene/streaming/made_plane_tiles.h"

namespace reljef::scene {
namespace {

using terrain::TileTree;
using terrain::TreeTile;
using namespace std::chrono_literals;
using namespace test::plane_tiles;

// Between samples of the overview nothing of what is missing is seen.
TEST(TileStreams, TilesMadeOfACoarserOverviewHaveItsError) {
    auto terrain = std::make_shared<terrain::Terrain>(overview()->terrain());
    Grid<float>& heights = terrain->heightfield.heights;
    std::fill(heights.samples().begin(), heights.samples().end(), 0.0F);
    heights(40, 40) = 16.0F; // over samples 320 to 327
    const auto surface = TerrainSurface::create(terrain);
    ASSERT_TRUE(surface);
    const TileBuilder make(std::make_shared<const TerrainSurface>(*surface), TileTree(side, side),
                           reduction);
    TileStream stream(make, [make](TreeTile tile, const std::stop_token& /*stop*/) {
        TileContent reading;
        reading.heights = make.overview_heights(tile);
        reading.of_overview = true;
        return reading;
    });
    stream.request(std::array{TreeTile{0, 5, 5}, TreeTile{0, 10, 10}});
    ASSERT_TRUE(stream.wait({}));
    EXPECT_FLOAT_EQ(static_cast<float>(stream.find({0, 5, 5})->error), 16.0F);
    EXPECT_EQ(stream.find({0, 10, 10})->error, 0.0);
    EXPECT_EQ(make.overview_error({3, 0, 0}), 0.0); // as far apart as the overview's
}

TEST(TileStreams, HavePicturesOfFewerTexelsWhereMemoryIsSmall) {
    for (const std::size_t megabytes : {16U, 60U, 100U, 140U, 400U}) {
        const std::size_t budget = megabytes << 20U;
        const int texels = TileStream::texels_within(budget);
        const TileBuilder make(overview(), TileTree(side, side), reduction,
                               {.finest_pixel = 0.1, .refinement = 1, .max_texels = texels});
        EXPECT_EQ(make.bytes_per_tile(), bytes_of_tile(texels));
        EXPECT_TRUE(texels == 1 || TileStream::min_drawn * make.bytes_per_tile() <= budget);
        EXPECT_TRUE(texels == max_texels_per_cell ||
                    2 * TileStream::min_drawn * bytes_of_tile(2 * texels) > budget);
    }
}

TEST(TileStreams, BringWhatIsWantedOnce) {
    std::atomic<int> readings{0};
    TileStream stream(maker(), [&](TreeTile tile, const std::stop_token& stop) {
        ++readings;
        return read_plane(tile, stop);
    });
    const auto tiles = level_0();
    stream.request(tiles);
    EXPECT_TRUE(stream.wait({}));
    stream.request(tiles);
    EXPECT_TRUE(stream.wait({}));
    EXPECT_EQ(readings, 64);
    EXPECT_FALSE(stream.is_busy());
    EXPECT_TRUE(stream.take_arrivals());
    EXPECT_FALSE(stream.take_arrivals());
    EXPECT_EQ(stream.find({0, 5, 5})->id, (TreeTile{0, 5, 5}));
    EXPECT_EQ(stream.stats().tiles, 64U);
}

TEST(TileStreams, StayWithinTheirMemoryAndDropTheLeastRecentlySeen) {
    TileStream stream(maker(), read_plane, {.memory_budget = 8 * bytes_per_tile, .threads = 2});
    for (const TreeTile tile : level_0()) {
        stream.request(std::array{tile});
        stream.wait({});
        ASSERT_NE(stream.find(tile), nullptr);
        ASSERT_LE(stream.stats().bytes, 9 * bytes_per_tile);
    }
    EXPECT_EQ(stream.find({0, 0, 0}), nullptr);
    EXPECT_NE(stream.find({0, 7, 7}), nullptr);
    EXPECT_EQ(stream.stats().evicted, 64 - static_cast<int>(stream.stats().tiles));
}

TEST(TileStreams, DropWhatOneViewHadTooMuchWhenOthersBegin) {
    TileStream stream(maker(), read_plane, {.memory_budget = 8 * bytes_per_tile, .threads = 2});
    stream.request(level_0());
    stream.wait({});
    EXPECT_EQ(stream.stats().tiles, 64U);
    stream.request({});
    stream.request({});
    EXPECT_LE(stream.stats().bytes, 8 * bytes_per_tile);
}

TEST(TileStreams, OfTheLastViewGiveWayToThoseOfTheNext) {
    TileStream stream(maker(), read_plane, {.memory_budget = 8 * bytes_per_tile, .threads = 2});
    const auto tiles = level_0();
    for (std::size_t first = 0; first < tiles.size(); first += 8) {
        stream.request(std::span(tiles).subspan(first, 8));
        stream.wait({});
        EXPECT_TRUE(stream.find(tiles[first]) && stream.find(tiles[first + 7]));
        ASSERT_LE(stream.stats().bytes, 9 * bytes_per_tile) << first;
    }
}

// 4301 tiles: more than are remembered of those that go.
TEST(TileStreams, RememberWhatWentThoughNotWithoutEnd) {
    constexpr int tiles = 4301;
    const TileBuilder narrow(overview(), TileTree(tiles * terrain::tree_tile_cells + 1, 3),
                             reduction);
    TileStream stream(narrow,
                      [&](TreeTile tile, const std::stop_token& /*stop*/) {
                          TileContent reading;
                          reading.heights =
                              test::tile_heights(narrow.tree().cells(tile),
                                                 [](glm::ivec2 vertex) { return 1.0 * vertex.x; });
                          return reading;
                      },
                      {.memory_budget = bytes_per_tile, .threads = 1});
    for (int col = 0; col < tiles; ++col) {
        stream.request(std::array{TreeTile{0, col, 0}});
        ASSERT_TRUE(stream.wait({}));
    }
    EXPECT_EQ(stream.find({0, 4000, 0}), nullptr);
    ASSERT_TRUE(stream.recall({0, 4000, 0}));
    EXPECT_EQ(stream.recall({0, 4000, 0})->id, (TreeTile{0, 4000, 0}));
    EXPECT_EQ(stream.recall({0, 4000, 0})->range.high, 64.0);
    EXPECT_TRUE(stream.recall({0, tiles - 1, 0}));
    EXPECT_FALSE(stream.recall({0, 0, 0}));
}

// A selection that depends on what was read before would change from frame to frame.
TEST(TileStreams, ProvenTilesHaveTheSameSummaryUnreadReadAndEvicted) {
    const TileBuilder builder = maker();
    const auto proof_of = [](TreeTile tile) {
        terrain::TileProof proof;
        proof.low = -5.0F;
        proof.high = 2000.0F + static_cast<float>(tile.col);
        proof.error = static_cast<float>(tile.level);
        return proof;
    };
    TileStreamOptions options{.memory_budget = bytes_per_tile, .threads = 1};
    options.find_proof = [&](TreeTile tile) {
        return tile.row == 0 ? std::optional(proof_of(tile)) : std::nullopt;
    };
    TileStream stream(
        builder,
        [](TreeTile tile, const std::stop_token&) {
            TileContent content = read_plane(tile, {});
            content.is_proven = tile.row == 0;
            return content;
        },
        options);
    const TreeTile tile{1, 1, 0};
    const auto unread = stream.recall(tile);
    ASSERT_TRUE(unread);
    EXPECT_TRUE(unread->is_proven);
    EXPECT_EQ(unread->error, 1.0);
    EXPECT_EQ(unread->range.high, 2001.0);
    EXPECT_GE(unread->bounds.high.z, 2002.0); // what is drawn is a metre off
    const auto expect_same = [&] {
        const auto now = stream.recall(tile);
        ASSERT_TRUE(now);
        EXPECT_EQ(now->bounds.low, unread->bounds.low);
        EXPECT_EQ(now->bounds.high, unread->bounds.high);
        EXPECT_EQ(now->error, unread->error);
        EXPECT_EQ(now->coarse_texel, unread->coarse_texel);
        EXPECT_TRUE(now->is_proven);
    };
    stream.request(std::array{tile});
    ASSERT_TRUE(stream.wait({}));
    ASSERT_NE(stream.find(tile), nullptr);
    expect_same();
    for (const TreeTile other : {TreeTile{1, 0, 1}, {1, 1, 1}, {1, 0, 0}}) {
        stream.request(std::array{other});
        ASSERT_TRUE(stream.wait({}));
    }
    EXPECT_EQ(stream.find(tile), nullptr);
    expect_same();
    EXPECT_FALSE(stream.recall({0, 3, 3})); // unread, unproven
}

// What fills a void may be higher than all samples of its tile: the range of a proof contains it.
TEST(TileStreams, BoundsOfProvenTilesContainTheRangeOfTheirProof) {
    const TileBuilder builder = maker();
    terrain::TileProof proof;
    proof.low = 1e4F;
    proof.high = 1e4F;
    const TreeTile tile{0, 3, 3};
    EXPECT_EQ(builder.summary(tile, proof).range.low, 1e4);
    const TileSummary summary = builder.summary(tile, terrain::with_fill(proof, {-5.0, 2e4}, 0));
    EXPECT_LE(summary.range.low, -5.0);
    EXPECT_GE(summary.range.high, 2e4);
    EXPECT_LE(summary.bounds.low.z, -5.0);
}

TEST(TileStreams, CancelWhatIsPassedBy) {
    std::atomic<bool> go_on{false};
    std::atomic<int> begun{0};
    TileStream stream(maker(),
                      [&](TreeTile tile, const std::stop_token& stop) {
                          ++begun;
                          while (!stop.stop_requested() && !go_on) {
                              std::this_thread::sleep_for(1ms);
                          }
                          return read_plane(tile, stop);
                      },
                      {.threads = 1});
    stream.request(level_0());
    while (begun == 0) {
        std::this_thread::sleep_for(1ms);
    }
    go_on = false;
    stream.request(std::array{TreeTile{3, 0, 0}});
    while (begun < 2) {
        std::this_thread::sleep_for(1ms);
    }
    go_on = true;
    EXPECT_TRUE(stream.wait({}));
    EXPECT_EQ(stream.stats().read, 1);
    EXPECT_EQ(stream.stats().cancelled, 64);
    EXPECT_NE(stream.find({3, 0, 0}), nullptr);
}

TEST(TileStreams, TryAFaultyTileAgainAndTellItsFileOnce) {
    std::atomic<int> readings{0};
    TileStream stream(maker(),
                      [&](TreeTile tile, const std::stop_token& stop) {
                          TileContent reading = read_plane(tile, stop);
                          if (++readings < 3) {
                              reading.errors = {{"a.tif", "a.tif: is cut"}};
                          }
                          return reading;
                      },
                      {.threads = 1, .first_pause = 1ms});
    stream.request(std::array{TreeTile{0, 0, 0}});
    EXPECT_TRUE(stream.wait({}));
    EXPECT_EQ(readings, 3);
    EXPECT_NE(stream.find({0, 0, 0}), nullptr);
    EXPECT_EQ(stream.stats().failed, 2);
    EXPECT_THAT(stream.take_errors(), ::testing::ElementsAre("a.tif: is cut"));
    EXPECT_TRUE(stream.take_errors().empty());
    EXPECT_EQ(stream.failed_files(), 1U);
}

TEST(TileStreams, DrawATileWhosePictureFailsAndReadItAgain) {
    std::atomic<int> readings{0};
    std::atomic<bool> recovers{false};
    TileStream stream(maker(),
                      [&](TreeTile tile, const std::stop_token& stop) {
                          TileContent reading = read_plane(tile, stop);
                          if (++readings < 3) {
                              reading.picture_errors = {{"a.tif", "a.tif: is cut"}};
                              return reading;
                          }
                          while (!recovers && !stop.stop_requested()) {
                              std::this_thread::sleep_for(1ms);
                          }
                          reading.picture.texels = Image(65, 65, Rgba8{9, 8, 7, 255});
                          return reading;
                      },
                      {.threads = 1, .first_pause = 1ms});
    stream.request(std::array{TreeTile{0, 0, 0}});
    while (stream.find({0, 0, 0}) == nullptr) {
        std::this_thread::sleep_for(1ms);
    }
    EXPECT_NE(stream.find({0, 0, 0})->albedo(5, 5), (Rgba8{9, 8, 7, 255}));
    recovers = true;
    stream.request({}, std::array{TreeTile{0, 0, 0}}); // it is in memory, and drawn
    EXPECT_TRUE(stream.wait({}));
    EXPECT_EQ(stream.find({0, 0, 0})->albedo(5, 5), (Rgba8{9, 8, 7, 255}));
    EXPECT_EQ(readings, 3);
    EXPECT_EQ(stream.stats().read, 1);
    EXPECT_THAT(stream.take_errors(), ::testing::ElementsAre("a.tif: is cut"));
    EXPECT_EQ(stream.failed_files(), 1U);
}

// A view that moves asks anew with each frame, while the picture is read again.
TEST(TileStreams, GoOnReadingAPictureWhileTheViewMoves) {
    std::atomic<int> readings{0};
    TileStream stream(maker(),
                      [&](TreeTile tile, const std::stop_token& stop) {
                          TileContent reading = read_plane(tile, stop);
                          if (++readings == 1) {
                              reading.picture_errors = {{"a.tif", "a.tif: is cut"}};
                              return reading;
                          }
                          for (int i = 0; i < 30 && !stop.stop_requested(); ++i) {
                              std::this_thread::sleep_for(1ms);
                          }
                          reading.picture.texels = Image(65, 65, Rgba8{9, 8, 7, 255});
                          return reading;
                      },
                      {.threads = 1, .first_pause = 1ms});
    const TreeTile tile{0, 0, 0};
    stream.request(std::array{tile});
    for (int frame = 0; frame < 30'000 && (stream.is_busy() || readings < 2); ++frame) {
        if (stream.find(tile) != nullptr) {
            stream.request({}, std::array{tile});
        }
        std::this_thread::sleep_for(2ms);
    }
    EXPECT_EQ(readings, 2);
    EXPECT_EQ(stream.stats().cancelled, 0);
    ASSERT_NE(stream.find(tile), nullptr);
    EXPECT_EQ(stream.find(tile)->albedo(5, 5), (Rgba8{9, 8, 7, 255}));
}

TEST(TileStreams, LeaveATileThatFailsForGoodAndDrawTheOthers) {
    TileStream stream(maker(),
                      [](TreeTile tile, const std::stop_token& stop) {
                          TileContent reading = read_plane(tile, stop);
                          if (tile.col == 3) { // each tile has a file of its own
                              const std::string file = std::to_string(tile.row) + ".tif";
                              reading.errors = {{file, file + ": is cut"}};
                          }
                          return reading;
                      },
                      {.threads = 2, .first_pause = 1ms});
    stream.request(level_0());
    EXPECT_TRUE(stream.wait({}));
    EXPECT_EQ(stream.stats().read, 56);
    EXPECT_EQ(stream.stats().failed, 8 * TileStream::max_attempts);
    EXPECT_FALSE(stream.is_busy());
    EXPECT_TRUE(stream.has_given_up({0, 3, 5}));
    EXPECT_FALSE(stream.has_given_up({0, 4, 5}));
}

// A view that was chosen with the failure in it would stay as it is.
TEST(TileStreams, HaveAnotherRevisionOnceATileIsGivenUp) {
    TileStream stream(maker(),
                      [](TreeTile tile, const std::stop_token& stop) {
                          TileContent reading = read_plane(tile, stop);
                          reading.errors = {{"b.tif", "b.tif: is gone"}};
                          return reading;
                      },
                      {.threads = 1, .first_pause = 1ms});
    const auto before = stream.revision();
    stream.request(std::array{TreeTile{0, 0, 0}});
    EXPECT_TRUE(stream.wait({}));
    ASSERT_TRUE(stream.has_given_up({0, 0, 0}));
    EXPECT_NE(stream.revision(), before);
}

// What a file is wrong with it is for all its tiles: only the first of them wait for it.
TEST(TileStreams, WaitOnceForAFileThatFailsForGood) {
    std::atomic<bool> is_back{false};
    TileStream stream(maker(),
                      [&](TreeTile tile, const std::stop_token& stop) {
                          TileContent reading = read_plane(tile, stop);
                          if (!is_back) {
                              reading.errors = {{"b.tif", "b.tif: is gone"}};
                          }
                          return reading;
                      },
                      {.threads = 2, .first_pause = 2ms});
    stream.request(std::array{TreeTile{0, 0, 0}});
    EXPECT_TRUE(stream.wait({}));
    EXPECT_EQ(stream.stats().failed, TileStream::max_attempts);
    stream.request(level_0());
    EXPECT_TRUE(stream.wait({}));
    EXPECT_EQ(stream.stats().failed, TileStream::max_attempts + 63);
    EXPECT_FALSE(stream.is_busy());
    // What of it was not tried is read as soon as it is wanted.
    is_back = true;
    stream.request(std::array{TreeTile{3, 0, 0}});
    EXPECT_TRUE(stream.wait({}));
    EXPECT_NE(stream.find({3, 0, 0}), nullptr);
}

TEST(TileStreams, EndInTheMiddleOfReading) {
    std::atomic<int> begun{0};
    for (int round = 0; round < 20; ++round) {
        TileStream stream(maker(), [&](TreeTile tile, const std::stop_token& stop) {
            ++begun;
            for (int i = 0; i < 1000 && !stop.stop_requested(); ++i) {
                std::this_thread::sleep_for(1ms);
            }
            return read_plane(tile, stop);
        });
        stream.request(level_0());
        std::stop_source stopped;
        stopped.request_stop();
        EXPECT_FALSE(stream.wait(stopped.get_token()));
    }
    EXPECT_LE(begun, 20 * static_cast<int>(thread_count(0)));
}

TEST(TileStreams, KnowTheGroundAtTheFinestTileThatIsThere) {
    auto stream = std::make_shared<TileStream>(maker(), read_plane);
    const TerrainNode node{overview(), {}, stream};
    EXPECT_FALSE(stream->finest_at({64.0, 64.0}));
    stream->request(std::array{TreeTile{4, 0, 0}, TreeTile{0, 8, 8}});
    stream->wait({});
    EXPECT_EQ(stream->finest_at({70.0, 70.0})->tile->id.level, 0);
    EXPECT_EQ(stream->finest_at({20.0, 70.0})->tile->id.level, 4);
    const auto z = height_at(node, 100.0, -50.0);
    ASSERT_TRUE(z);
    EXPECT_NEAR(*z, *node.surface->height_at(100.0, -50.0), 1e-3);
}

} // namespace
} // namespace reljef::scene
