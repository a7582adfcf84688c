#include "engine/scene/tile_stream.h"

#include <atomic>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/worker_pool.h"
#include "tests/terrain/made_tiles.h"

namespace reljef::scene {
namespace {

using terrain::TileTree;
using terrain::TreeTile;
using namespace std::chrono_literals;

constexpr int side = 1025; // samples of the raster
constexpr int reduction = 8;

double height_of(glm::dvec2 sample) {
    return 0.25 * sample.x - 0.5 * sample.y + 3.0;
}

std::shared_ptr<const TerrainSurface> overview() {
    auto heightfield = test::plane_heightfield(test::overview_heights(side, reduction, height_of));
    heightfield.spacing = glm::dvec2(10.0 * reduction);
    auto surface = TerrainSurface::create(std::make_shared<const terrain::Terrain>(
        terrain::Terrain{"made", std::move(heightfield), {}, {}}));
    EXPECT_TRUE(surface);
    return std::make_shared<const TerrainSurface>(std::move(*surface));
}

TileReading read_plane(TreeTile tile, const std::stop_token& /*stop*/) {
    const TileTree tree(side, side);
    TileReading reading;
    reading.heights = test::tile_heights(tree.cells(tile), [&](glm::ivec2 vertex) {
        return height_of(glm::dvec2(tree.sample(tile, vertex)));
    });
    return reading;
}

TileMaker maker() {
    return {overview(), TileTree(side, side), reduction};
}

std::vector<TreeTile> level_0() {
    std::vector<TreeTile> tiles;
    for (int i = 0; i < 64; ++i) {
        tiles.push_back({0, i % 8, i / 8});
    }
    return tiles;
}

TEST(TileMakers, PlaceTilesOfEveryLevelOnTheSurfaceOfTheOverview) {
    const TileMaker make = maker();
    const auto& placement = make.overview().placement();
    for (const TreeTile tile : {TreeTile{3, 0, 0}, {2, 1, 0}, {1, 3, 2}, {0, 7, 7}, {0, 0, 5}}) {
        const StreamedTile made = make.make(tile, read_plane(tile, {}).heights);
        for (int row = 0; row <= made.cells.y; row += 16) {
            for (int col = 0; col <= made.cells.x; col += 16) {
                const glm::dvec2 sample(make.tree().sample(tile, {col, row}));
                const glm::dvec3 expected =
                    placement.world_from_sample({make.on_overview(sample), height_of(sample)});
                const glm::dvec3 found = made.place({col, row});
                ASSERT_NEAR(found.x, expected.x, 1e-3);
                ASSERT_NEAR(found.y, expected.y, 1e-3);
                ASSERT_NEAR(found.z, expected.z, 1e-3);
                // Of the plane z = 0.025 x + 0.05 y.
                const glm::vec3 normal = made.normals(col, row);
                ASSERT_NEAR(normal.x / normal.z, -0.025, 1e-4);
                ASSERT_NEAR(normal.y / normal.z, -0.05, 1e-4);
            }
        }
        EXPECT_NEAR(made.error, 0.0, 1e-3); // a plane: nothing is gained by more
    }
}

TEST(TileMakers, FillVoidsWithTheOverview) {
    auto heights = read_plane({0, 3, 3}, {}).heights;
    heights(60, 60) = std::numeric_limits<float>::quiet_NaN();
    const StreamedTile made = maker().make({0, 3, 3}, std::move(heights));
    EXPECT_NEAR(made.heights(59, 59), height_of({3 * 128 + 59, 3 * 128 + 59}), 1e-3);
    EXPECT_EQ(made.albedo(59, 59), terrain::HeightTint::of_void());
}

TEST(TileMakers, ShowPicturesAndTheTintWhereTheyShowNothing) {
    const TileMaker make(overview(), TileTree(side, side), reduction,
                         {.finest_pixel = 2.0, .refinement = 1});
    const TreeTile tile{0, 3, 3};
    EXPECT_EQ(make.picture_size(tile), glm::ivec2(513)); // 10 m a cell: at most four texels
    EXPECT_EQ(make.picture_size({3, 0, 0}), glm::ivec2(513));
    TilePicture picture{Image(513, 513, Rgba8{0, 0, 0, 0}), true, true};
    picture.texels(512, 0) = {1, 2, 3, 255};
    const StreamedTile made = make.make(tile, read_plane(tile, {}).heights, picture);
    EXPECT_EQ(made.albedo(512, 0), (Rgba8{1, 2, 3, 255}));
    EXPECT_EQ(made.albedo(511, 1), make.make(tile, read_plane(tile, {}).heights).albedo(128, 0));
    EXPECT_DOUBLE_EQ(made.coarse_texel, 2.5);
    EXPECT_GT(made.bytes(), 2 * bytes_per_tile);
    EXPECT_LE(made.bytes(), make.bytes_per_tile());
}

TEST(TileMakers, MakeTheCoarsestTilesOfTheOverview) {
    const TileMaker make = maker();
    for (const int level : {3, 2, 0}) {
        const TreeTile tile{level, 0, 0};
        const Grid<float> found = make.overview_heights(tile);
        const Grid<float> expected = read_plane(tile, {}).heights;
        ASSERT_EQ(found.cols(), expected.cols());
        // Away from the border, where the overview ends half of its samples earlier.
        const int margin = 2 * reduction;
        for (int row = margin; row < found.rows() - margin; ++row) {
            for (int col = margin; col < found.cols() - margin; ++col) {
                ASSERT_NEAR(found(col, row), expected(col, row), 1e-3) << level;
            }
        }
    }
}

TEST(TileMakers, AveragesOfTheOverviewAreAsWideAsAStep) {
    auto terrain = std::make_shared<terrain::Terrain>(overview()->terrain());
    Grid<float>& heights = terrain->heightfield.heights;
    std::fill(heights.samples().begin(), heights.samples().end(), 0.0F);
    heights(40, 40) = 16.0F; // over samples 320 to 327
    const auto surface = TerrainSurface::create(terrain);
    ASSERT_TRUE(surface);
    // Levels whose steps are 2 and 4 of the overview's samples: vertices at 320 and 320 ± 32.
    const TileMaker make(std::make_shared<const TerrainSurface>(*surface), TileTree(9217, 9217),
                         reduction);
    EXPECT_FLOAT_EQ(make.overview_heights({4, 0, 0})(21, 21), 16.0F / 4.0F);
    EXPECT_FLOAT_EQ(make.overview_heights({5, 0, 0})(11, 11), 16.0F / 16.0F);
    EXPECT_FLOAT_EQ(make.overview_heights({5, 0, 0})(12, 12), 0.0F);
}

// Between samples of the overview nothing of what is missing is seen.
TEST(TileStreams, TilesMadeOfACoarserOverviewHaveItsError) {
    auto terrain = std::make_shared<terrain::Terrain>(overview()->terrain());
    Grid<float>& heights = terrain->heightfield.heights;
    std::fill(heights.samples().begin(), heights.samples().end(), 0.0F);
    heights(40, 40) = 16.0F; // over samples 320 to 327
    const auto surface = TerrainSurface::create(terrain);
    ASSERT_TRUE(surface);
    const TileMaker make(std::make_shared<const TerrainSurface>(*surface), TileTree(side, side),
                         reduction);
    TileStream stream(make, [make](TreeTile tile, const std::stop_token& /*stop*/) {
        TileReading reading;
        reading.heights = make.overview_heights(tile);
        reading.of_overview = true;
        return reading;
    });
    stream.want(std::array{TreeTile{0, 2, 2}, TreeTile{0, 5, 5}});
    ASSERT_TRUE(stream.wait({}));
    EXPECT_FLOAT_EQ(static_cast<float>(stream.find({0, 2, 2})->error), 16.0F);
    EXPECT_EQ(stream.find({0, 5, 5})->error, 0.0);
    EXPECT_EQ(make.overview_error({3, 0, 0}), 0.0); // as far apart as the overview's
}

TEST(TileStreams, HavePicturesOfFewerTexelsWhereMemoryIsSmall) {
    for (const std::size_t megabytes : {16U, 70U, 100U, 140U, 400U}) {
        const std::size_t budget = megabytes << 20U;
        const int texels = TileStream::texels_within(budget);
        EXPECT_EQ(texels, megabytes < 80 ? 1 : megabytes < 135 ? 2 : 4);
        const TileMaker make(overview(), TileTree(side, side), reduction,
                             {.finest_pixel = 0.1, .refinement = 1, .most_texels = texels});
        EXPECT_EQ(make.bytes_per_tile(), bytes_of_tile(texels));
        EXPECT_TRUE(texels == 1 || 2 * TileStream::least_drawn * make.bytes_per_tile() <= budget);
    }
}

TEST(TileMakers, RefinedOnesStandOnTheSameGround) {
    const TileMaker make(overview(), TileTree(4 * side - 3, 4 * side - 3), reduction,
                         {.finest_pixel = 0.5, .refinement = 4});
    EXPECT_EQ(make.first({0, 4, 8}), glm::dvec2(128.0, 256.0));
    EXPECT_EQ(make.sample({0, 4, 8}, {2, 4}), glm::dvec2(128.5, 257.0));
    EXPECT_DOUBLE_EQ(make.spacing(0), 2.5);
    EXPECT_DOUBLE_EQ(make.spacing(2), 10.0);
    EXPECT_TRUE(make.has_all_samples({2, 0, 0}));
    EXPECT_FALSE(make.has_all_samples({3, 0, 0}));
    const glm::dvec3 expected = maker().place({0, 1, 2}, {0, 0}, 5.0);
    EXPECT_EQ(make.place({0, 4, 8}, {0, 0}, 5.0), expected);
}

TEST(TileStreams, BringWhatIsWantedOnce) {
    std::atomic<int> readings{0};
    TileStream stream(maker(), [&](TreeTile tile, const std::stop_token& stop) {
        ++readings;
        return read_plane(tile, stop);
    });
    const auto tiles = level_0();
    stream.want(tiles);
    EXPECT_TRUE(stream.wait({}));
    stream.want(tiles);
    EXPECT_TRUE(stream.wait({}));
    EXPECT_EQ(readings, 64);
    EXPECT_FALSE(stream.is_busy());
    EXPECT_TRUE(stream.take_news());
    EXPECT_FALSE(stream.take_news());
    EXPECT_EQ(stream.find({0, 5, 5})->id, (TreeTile{0, 5, 5}));
    EXPECT_EQ(stream.stats().tiles, 64U);
}

TEST(TileStreams, StayWithinTheirMemoryAndDropTheLeastRecentlySeen) {
    TileStream stream(maker(), read_plane, {.memory_budget = 8 * bytes_per_tile, .threads = 2});
    for (const TreeTile tile : level_0()) {
        stream.want(std::array{tile});
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
    stream.want(level_0());
    stream.wait({});
    EXPECT_EQ(stream.stats().tiles, 64U);
    stream.want({});
    stream.want({});
    EXPECT_LE(stream.stats().bytes, 8 * bytes_per_tile);
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
    stream.want(level_0());
    while (begun == 0) {
        std::this_thread::sleep_for(1ms);
    }
    go_on = false;
    stream.want(std::array{TreeTile{3, 0, 0}});
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
                          TileReading reading = read_plane(tile, stop);
                          if (++readings < 3) {
                              reading.faults = {{"a.tif", "a.tif: is cut"}};
                          }
                          return reading;
                      },
                      {.threads = 1, .first_pause = 1ms});
    stream.want(std::array{TreeTile{0, 0, 0}});
    EXPECT_TRUE(stream.wait({}));
    EXPECT_EQ(readings, 3);
    EXPECT_NE(stream.find({0, 0, 0}), nullptr);
    EXPECT_EQ(stream.stats().failed, 2);
    EXPECT_THAT(stream.take_faults(), ::testing::ElementsAre("a.tif: is cut"));
    EXPECT_TRUE(stream.take_faults().empty());
    EXPECT_EQ(stream.faulty_files(), 1U);
}

TEST(TileStreams, DrawATileWhosePictureFailsAndReadItAgain) {
    std::atomic<int> readings{0};
    TileStream stream(maker(),
                      [&](TreeTile tile, const std::stop_token& stop) {
                          TileReading reading = read_plane(tile, stop);
                          if (++readings < 3) {
                              reading.picture_faults = {{"a.tif", "a.tif: is cut"}};
                          } else {
                              reading.picture.texels = Image(129, 129, Rgba8{9, 8, 7, 255});
                          }
                          return reading;
                      },
                      {.threads = 1, .first_pause = 20ms});
    stream.want(std::array{TreeTile{0, 0, 0}});
    while (stream.find({0, 0, 0}) == nullptr) {
        std::this_thread::sleep_for(1ms);
    }
    EXPECT_NE(stream.find({0, 0, 0})->albedo(5, 5), (Rgba8{9, 8, 7, 255}));
    stream.want({}); // it is there, and drawn
    EXPECT_TRUE(stream.wait({}));
    EXPECT_EQ(stream.find({0, 0, 0})->albedo(5, 5), (Rgba8{9, 8, 7, 255}));
    EXPECT_EQ(readings, 3);
    EXPECT_EQ(stream.stats().read, 1);
    EXPECT_THAT(stream.take_faults(), ::testing::ElementsAre("a.tif: is cut"));
    EXPECT_EQ(stream.faulty_files(), 1U);
}

// A view that moves asks anew with each frame, while the picture is read again.
TEST(TileStreams, GoOnReadingAPictureWhileTheViewMoves) {
    std::atomic<int> readings{0};
    TileStream stream(maker(),
                      [&](TreeTile tile, const std::stop_token& stop) {
                          TileReading reading = read_plane(tile, stop);
                          if (++readings == 1) {
                              reading.picture_faults = {{"a.tif", "a.tif: is cut"}};
                              return reading;
                          }
                          for (int i = 0; i < 30 && !stop.stop_requested(); ++i) {
                              std::this_thread::sleep_for(1ms);
                          }
                          reading.picture.texels = Image(129, 129, Rgba8{9, 8, 7, 255});
                          return reading;
                      },
                      {.threads = 1, .first_pause = 1ms});
    const TreeTile tile{0, 0, 0};
    stream.want(std::array{tile});
    for (int frame = 0; frame < 200 && (stream.is_busy() || readings < 2); ++frame) {
        if (stream.find(tile) != nullptr) {
            stream.want({});
        }
        std::this_thread::sleep_for(2ms);
    }
    EXPECT_EQ(readings, 2);
    EXPECT_EQ(stream.stats().cancelled, 0);
    ASSERT_NE(stream.find(tile), nullptr);
    EXPECT_EQ(stream.find(tile)->albedo(5, 5), (Rgba8{9, 8, 7, 255}));
}

TEST(TileStreams, TakeOfALaterReadingOnlyAPictureThatShowsMore) {
    std::atomic<int> readings{0};
    TileStream stream(maker(),
                      [&](TreeTile tile, const std::stop_token& stop) {
                          const int reading_now = ++readings;
                          TileReading reading = read_plane(tile, stop);
                          if (reading_now > 1) { // the file has changed meanwhile
                              for (float& height : reading.heights.samples()) {
                                  height += 100.0F;
                              }
                          }
                          reading.picture.texels = Image(129, 129, Rgba8{0, 0, 0, 0});
                          const int shown = reading_now == 1 ? 4 : reading_now == 2 ? 1 : 9;
                          for (int col = 0; col < shown; ++col) {
                              reading.picture.texels(col, 0) = {9, 8, 7, 255};
                          }
                          if (reading_now < 3) {
                              reading.picture_faults = {{"a.tif", "a.tif: is cut"}};
                          }
                          return reading;
                      },
                      {.threads = 1, .first_pause = 30ms});
    const TreeTile tile{0, 0, 0};
    stream.want(std::array{tile});
    while (stream.find(tile) == nullptr) {
        std::this_thread::sleep_for(1ms);
    }
    const auto first = stream.find(tile);
    stream.want({});
    while (stream.stats().failed < 2) {
        std::this_thread::sleep_for(1ms);
    }
    EXPECT_EQ(stream.find(tile), first);
    EXPECT_TRUE(stream.wait({}));
    const auto last = stream.find(tile);
    EXPECT_EQ(last->albedo(8, 0), (Rgba8{9, 8, 7, 255}));
    EXPECT_EQ(last->heights, first->heights);
    EXPECT_EQ(last->positions, first->positions);
}

// What the overview stands in for is replaced once it can be read; its picture stays where it shows
// more.
TEST(TileStreams, TakeOfALaterReadingTheHeightsThatTheOverviewStoodInFor) {
    std::atomic<int> readings{0};
    TileStream stream(maker(),
                      [&](TreeTile tile, const std::stop_token& stop) {
                          const int reading_now = ++readings;
                          TileReading reading = read_plane(tile, stop);
                          reading.of_overview = reading_now == 1 || reading_now == 3;
                          if (reading.of_overview) {
                              for (float& height : reading.heights.samples()) {
                                  height += 100.0F;
                              }
                          }
                          reading.picture.texels = Image(129, 129, Rgba8{0, 0, 0, 0});
                          const int shown = reading_now == 1 ? 4 : 1;
                          for (int col = 0; col < shown; ++col) {
                              reading.picture.texels(col, 0) = {9, 8, 7, 255};
                          }
                          if (reading_now < 4) {
                              reading.picture_faults = {{"a.tif", "a.tif: is cut"}};
                          }
                          return reading;
                      },
                      {.threads = 1, .first_pause = 10ms});
    const TreeTile tile{0, 0, 0};
    stream.want(std::array{tile});
    while (stream.find(tile) == nullptr) {
        std::this_thread::sleep_for(1ms);
    }
    while (stream.stats().failed < 2) {
        std::this_thread::sleep_for(1ms);
    }
    const auto recovered = stream.find(tile);
    EXPECT_FALSE(recovered->of_overview);
    EXPECT_NEAR(recovered->heights(5, 5), height_of({5.0, 5.0}), 1e-3);
    EXPECT_EQ(recovered->albedo(3, 0), (Rgba8{9, 8, 7, 255}));
    EXPECT_TRUE(stream.wait({}));
    const auto last = stream.find(tile);
    EXPECT_EQ(readings, 4);
    EXPECT_EQ(last->heights, recovered->heights);
    EXPECT_NE(last->albedo(3, 0), (Rgba8{9, 8, 7, 255}));
}

TEST(TileStreams, LeaveATileThatFailsForGoodAndDrawTheOthers) {
    TileStream stream(maker(),
                      [](TreeTile tile, const std::stop_token& stop) {
                          TileReading reading = read_plane(tile, stop);
                          if (tile.col == 3) { // each tile has a file of its own
                              const std::string file = std::to_string(tile.row) + ".tif";
                              reading.faults = {{file, file + ": is cut"}};
                          }
                          return reading;
                      },
                      {.threads = 2, .first_pause = 1ms});
    stream.want(level_0());
    EXPECT_TRUE(stream.wait({}));
    EXPECT_EQ(stream.stats().read, 56);
    EXPECT_EQ(stream.stats().failed, 8 * TileStream::most_attempts);
    EXPECT_FALSE(stream.is_busy());
    EXPECT_TRUE(stream.has_given_up({0, 3, 5}));
    EXPECT_FALSE(stream.has_given_up({0, 4, 5}));
}

// What a file is wrong with it is for all its tiles: only the first of them wait for it.
TEST(TileStreams, WaitOnceForAFileThatFailsForGood) {
    std::atomic<bool> is_back{false};
    TileStream stream(maker(),
                      [&](TreeTile tile, const std::stop_token& stop) {
                          TileReading reading = read_plane(tile, stop);
                          if (!is_back) {
                              reading.faults = {{"b.tif", "b.tif: is gone"}};
                          }
                          return reading;
                      },
                      {.threads = 2, .first_pause = 2ms});
    stream.want(std::array{TreeTile{0, 0, 0}});
    EXPECT_TRUE(stream.wait({}));
    EXPECT_EQ(stream.stats().failed, TileStream::most_attempts);
    stream.want(level_0());
    EXPECT_TRUE(stream.wait({}));
    EXPECT_EQ(stream.stats().failed, TileStream::most_attempts + 63);
    EXPECT_FALSE(stream.is_busy());
    // What of it was not tried is read as soon as it is wanted.
    is_back = true;
    stream.want(std::array{TreeTile{3, 0, 0}});
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
        stream.want(level_0());
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
    stream->want(std::array{TreeTile{3, 0, 0}, TreeTile{0, 4, 4}});
    stream->wait({});
    EXPECT_EQ(stream->finest_at({70.0, 70.0})->tile->id.level, 0);
    EXPECT_EQ(stream->finest_at({20.0, 70.0})->tile->id.level, 3);
    const auto z = height_at(node, 100.0, -50.0);
    ASSERT_TRUE(z);
    EXPECT_NEAR(*z, *node.surface->height_at(100.0, -50.0), 1e-3);
}

} // namespace
} // namespace reljef::scene
