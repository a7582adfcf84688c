// Tiles of sources that change.
#include <array>
#include <atomic>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/scene/streaming/tile_stream.h"
#include "tests/scene/streaming/made_plane_tiles.h"

namespace reljef::scene {
namespace {

using terrain::TreeTile;
using namespace std::chrono_literals;
using namespace test::plane_tiles;

// Each change raises the plane by 100 m.
class ChangingSource : public ::testing::Test {
protected:
    static constexpr TreeTile seen{0, 0, 0};
    static constexpr TreeTile unseen{0, 1, 0};
    static constexpr TreeTile next{0, 2, 0};

    TileContent read(TreeTile tile, const std::stop_token& stop) {
        TileContent content = read_plane(tile, stop);
        for (float& height : content.heights.samples()) {
            height += 100.0F * static_cast<float>(changes_);
        }
        if (changes_while_read_ && readings_ == 0) {
            ++changes_;
        }
        if (is_cut_) {
            content.errors = {{"a.tif", "a.tif: is cut"}};
        }
        ++readings_;
        return content;
    }
    void load(std::span<const TreeTile> missing, std::span<const TreeTile> used) {
        stream_.request(missing, used);
        EXPECT_TRUE(stream_.wait({}));
    }
    [[nodiscard]] float height(TreeTile tile) const {
        return stream_.find(tile)->heightfield.heights(0, 0);
    }

    std::atomic<int> changes_{0};
    std::atomic<bool> changes_while_read_{false};
    std::atomic<bool> is_cut_{false};
    std::atomic<int> readings_{0};
    TileStream stream_{
        maker(),
        [this](TreeTile tile, const std::stop_token& stop) { return read(tile, stop); },
        {.threads = 1,
         .source_changes = [this] { return static_cast<std::uint64_t>(changes_); },
         .first_pause = 1ms}};
};

TEST_F(ChangingSource, TilesInUseAreShownUntilTheyAreReadAgainAndOthersAreForgotten) {
    load(std::array{seen, unseen}, {});
    load({}, std::array{seen});
    const auto before = stream_.find(seen);
    const std::size_t bytes_of_two = stream_.stats().bytes;
    ++changes_;
    load(std::array{next}, std::array{seen});
    EXPECT_EQ(stream_.find(seen), before);
    EXPECT_EQ(stream_.find(unseen), nullptr);
    EXPECT_FALSE(stream_.recall(unseen)) << "its heights may be others now";
    EXPECT_TRUE(stream_.has_outdated());
    EXPECT_EQ(stream_.stats().bytes, bytes_of_two) << "one came, one went";
    stream_.take_arrivals();
    const std::uint64_t revision = stream_.revision();
    load({}, std::array{seen, next});
    EXPECT_FLOAT_EQ(height(seen), before->heightfield.heights(0, 0) + 100.0F);
    EXPECT_FALSE(stream_.has_outdated());
    EXPECT_EQ(stream_.stats().bytes, bytes_of_two);
    EXPECT_EQ(readings_, 4) << "what was read after the change is not read again";
    EXPECT_TRUE(stream_.take_arrivals());
    EXPECT_NE(stream_.revision(), revision);
}

TEST_F(ChangingSource, AChangeDuringAReadingOutdatesItsTile) {
    changes_while_read_ = true;
    load(std::array{seen}, {});
    const float before = height(seen);
    EXPECT_TRUE(stream_.has_outdated());
    load({}, std::array{seen});
    EXPECT_FLOAT_EQ(height(seen), before + 100.0F);
    EXPECT_FALSE(stream_.has_outdated());
}

TEST_F(ChangingSource, AnOutdatedTileThatCannotBeReadStays) {
    load(std::array{seen}, {});
    const auto before = stream_.find(seen);
    ++changes_;
    is_cut_ = true;
    load(std::array{next}, std::array{seen});
    load({}, std::array{seen});
    EXPECT_EQ(stream_.find(seen), before);
    EXPECT_FALSE(stream_.has_outdated()) << "no frame waits for it";
    EXPECT_FALSE(stream_.take_errors().empty());
}

} // namespace
} // namespace reljef::scene
