// An index that several processes make.
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/index/index_pass.h"
#include "tests/session/made_waves.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

namespace fs = std::filesystem;

/// A raster of 3×2 chunks.
class IndexShares : public testing::Test {
protected:
    void SetUp() override { test::write_waves(folder_.path() / "dem.tif", 2100, 1100); }

    [[nodiscard]] IndexSource source(const std::string& cache) const {
        auto tiles = TileSet::open(folder_.path() / "dem.tif");
        EXPECT_TRUE(tiles) << tiles.error().message;
        const TileGrid grid = tiles->grid();
        auto source = index_source(std::move(*tiles), grid, Gaps::holes, folder_.path() / cache);
        EXPECT_TRUE(source) << source.error().message;
        return std::move(*source);
    }
    [[nodiscard]] std::string whole() const {
        const IndexSource alone = source("whole");
        EXPECT_TRUE(make_index(alone, {}));
        return test::read_bytes(alone.file);
    }
    static std::size_t unproven(const IndexReport& report) {
        std::size_t count = 0;
        for (const auto& level : report.levels) {
            count += level.unproven;
        }
        return count;
    }
    test::TemporaryFolder folder_;
};

TEST_F(IndexShares, ShardsThatRunAtTheSameTimeMakeTheIndexOfOne) {
    const IndexSource shared = source("shared");
    std::vector<std::jthread> workers;
    constexpr int count = 4;
    for (int i = 0; i < count; ++i) {
        workers.emplace_back([&, i] {
            const auto made = make_index(shared, {.threads = 1, .stop = {}, .progress = {}},
                                         {.shard = {i, count}});
            EXPECT_TRUE(made) << made.error().message;
        });
    }
    workers.clear();
    EXPECT_EQ(test::read_bytes(shared.file), whole());
}

TEST_F(IndexShares, TheLastOfSeveralShardsCompletesTheIndex) {
    const IndexSource shared = source("shared");
    const auto first = make_index(shared, {}, {.shard = {0, 2}});
    ASSERT_TRUE(first) << first.error().message;
    EXPECT_GT(unproven(*first), 0U);
    const auto last = make_index(shared, {}, {.shard = {1, 2}});
    ASSERT_TRUE(last) << last.error().message;
    EXPECT_EQ(unproven(*last), 0U);
    EXPECT_EQ(test::read_bytes(shared.file), whole());
}

TEST_F(IndexShares, WhatAKilledProcessLeftIsCompletedWithoutShards) {
    const IndexSource shared = source("shared");
    ASSERT_TRUE(make_index(shared, {}, {.shard = {0, 3}}));
    ASSERT_TRUE(make_index(shared, {}, {.shard = {2, 3}})); // and not the second
    const auto made = make_index(shared, {});
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_EQ(unproven(*made), 0U);
    EXPECT_EQ(test::read_bytes(shared.file), whole());
}

TEST_F(IndexShares, OneThatWritesAloneRefusesOthersWhileShardsDoNot) {
    const IndexSource shared = source("shared");
    auto first = ErrorIndex::open_to_write(shared, IndexAccess::shared);
    ASSERT_TRUE(first) << first.error().message;
    auto second = ErrorIndex::open_to_write(shared, IndexAccess::shared);
    ASSERT_TRUE(second) << second.error().message;
    EXPECT_FALSE(ErrorIndex::open_to_write(shared));
    EXPECT_FALSE(second->claim()) << "the first writes still";
    EXPECT_TRUE(first->claim()) << "the second gave its lock back";
}

TEST_F(IndexShares, AnIndexThatWasRemovedMeanwhileIsNotClaimed) {
    const IndexSource shared = source("shared");
    auto index = ErrorIndex::open_to_write(shared, IndexAccess::shared);
    ASSERT_TRUE(index);
    fs::remove(shared.file);
    EXPECT_FALSE(index->claim());
}

TEST_F(IndexShares, AStopEndsTheWaitForAProcessThatWritesAlone) {
    const IndexSource shared = source("shared");
    const auto alone = ErrorIndex::open_to_write(shared);
    ASSERT_TRUE(alone);
    std::stop_source stop;
    stop.request_stop();
    const auto waited = ErrorIndex::open_to_write(shared, IndexAccess::queued, stop.get_token());
    ASSERT_FALSE(waited);
    EXPECT_THAT(waited.error().message, testing::HasSubstr("another process indexes"));
}

TEST_F(IndexShares, AWaitForAnotherProcessIsReportedOnce) {
    const IndexSource shared = source("shared");
    const auto alone = ErrorIndex::open_to_write(shared);
    ASSERT_TRUE(alone);
    std::stop_source stop;
    int calls = 0;
    EXPECT_FALSE(ErrorIndex::open_to_write(shared, IndexAccess::queued, stop.get_token(), [&] {
        ++calls;
        stop.request_stop();
    }));
    EXPECT_EQ(calls, 1);
}

} // namespace
} // namespace reljef::io
