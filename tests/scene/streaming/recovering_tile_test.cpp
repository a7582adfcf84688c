#include <array>
#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/scene/streaming/tile_stream.h"
#include "tests/scene/streaming/made_plane_tiles.h"

namespace reljef::scene {
namespace {

using terrain::TreeTile;
using namespace std::chrono_literals;
using namespace test::plane_tiles;

// Readings of one tile, one after the other, each once it may begin.
class RecoveringTile : public ::testing::Test {
protected:
    struct Attempt {
        float heights_above = 0.0F; // the plane
        bool of_overview = false;
        int texels_shown = 0;
        bool fails = false;
        bool is_unreadable = false;
    };
    static constexpr TreeTile tile{0, 0, 0};
    static constexpr Rgba8 shown{9, 8, 7, 255};

    std::shared_ptr<const TerrainTile> first_of(std::vector<Attempt> attempts) {
        attempts_ = std::move(attempts);
        may_begin_ = 1;
        stream_ = std::make_unique<TileStream>(
            maker(),
            [this](TreeTile requested, const std::stop_token& stop) {
                const int number = readings_++;
                while (number >= may_begin_ && !stop.stop_requested()) {
                    std::this_thread::sleep_for(1ms);
                }
                if (stop.stop_requested()) {
                    return TileContent{};
                }
                return read(attempts_.at(static_cast<std::size_t>(number)), requested, stop);
            },
            TileStreamOptions{.threads = 1, .first_pause = 1ms});
        stream_->request(std::array{tile});
        while (stream_->find(tile) == nullptr) {
            std::this_thread::sleep_for(1ms);
        }
        return stream_->find(tile);
    }
    std::shared_ptr<const TerrainTile> after_failures(int count) {
        may_begin_ = count;
        while (stream_->stats().failed < count) {
            std::this_thread::sleep_for(1ms);
        }
        return stream_->find(tile);
    }
    std::shared_ptr<const TerrainTile> last() {
        may_begin_ = static_cast<int>(attempts_.size());
        EXPECT_TRUE(stream_->wait({}));
        EXPECT_EQ(static_cast<std::size_t>(readings_), attempts_.size());
        return stream_->find(tile);
    }

    std::unique_ptr<TileStream> stream_;

private:
    static TileContent read(const Attempt& attempt, TreeTile requested,
                            const std::stop_token& stop) {
        if (attempt.is_unreadable) {
            TileContent nothing;
            nothing.errors = {{"heights.tif", "heights.tif: is gone"}};
            return nothing;
        }
        TileContent reading = read_plane(requested, stop);
        reading.of_overview = attempt.of_overview;
        for (float& height : reading.heights.samples()) {
            height += attempt.heights_above;
        }
        reading.picture.texels = Image(65, 65, Rgba8{0, 0, 0, 0});
        for (int col = 0; col < attempt.texels_shown; ++col) {
            reading.picture.texels(col, 0) = shown;
        }
        if (attempt.fails) {
            reading.picture_errors = {{"a.tif", "a.tif: is cut"}};
        }
        return reading;
    }

    std::vector<Attempt> attempts_;
    std::atomic<int> readings_{0};
    std::atomic<int> may_begin_{0};
};

TEST_F(RecoveringTile, TakesOfALaterReadingOnlyAPictureThatShowsMore) {
    const auto first = first_of({{.texels_shown = 4, .fails = true},
                                 {.heights_above = 100.0F, .texels_shown = 1, .fails = true},
                                 {.heights_above = 100.0F, .texels_shown = 9}});
    EXPECT_EQ(after_failures(2), first);
    const auto recovered = last();
    EXPECT_EQ(recovered->albedo(8, 0), shown);
    EXPECT_EQ(recovered->heightfield.heights, first->heightfield.heights);
}

// What the overview stands in for is replaced once it can be read; its picture stays where it shows
// more.
TEST_F(RecoveringTile, TakesOfALaterReadingTheHeightsThatTheOverviewStoodInFor) {
    const Attempt of_overview{.heights_above = 100.0F, .of_overview = true, .fails = true};
    Attempt more_shown = of_overview;
    more_shown.texels_shown = 4;
    static_cast<void>(first_of(
        {more_shown, {.texels_shown = 1, .fails = true}, of_overview, {.texels_shown = 1}}));
    const auto recovered = after_failures(2);
    EXPECT_FALSE(recovered->of_overview);
    EXPECT_NEAR(recovered->heightfield.heights(5, 5), height_of({5.0, 5.0}), 1e-3);
    EXPECT_EQ(recovered->albedo(3, 0), shown);
    const auto whole = last();
    EXPECT_EQ(whole->heightfield.heights, recovered->heightfield.heights);
    EXPECT_NE(whole->albedo(3, 0), shown);
}

TEST_F(RecoveringTile, HasConesThoughItsFileCannotBeReadAgain) {
    // The second reading may have begun before cones were requested.
    const auto first = first_of(
        {{.texels_shown = 4, .fails = true}, {.is_unreadable = true}, {.is_unreadable = true}});
    EXPECT_EQ(first->cones, nullptr);
    stream_->request(std::array{tile}, std::array{tile}, true);
    const auto after = after_failures(3);
    ASSERT_NE(after->cones, nullptr);
    EXPECT_EQ(after->heightfield.heights.samples()[0], first->heightfield.heights.samples()[0]);
    const std::vector<std::string> notes = stream_->take_notes();
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_THAT(notes[0], ::testing::HasSubstr("cones"));
    EXPECT_THAT(stream_->take_errors(), ::testing::Contains(std::string("heights.tif: is gone")));
}

} // namespace
} // namespace reljef::scene
