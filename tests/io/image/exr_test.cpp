#include <cmath>
#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/image/image.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

using ::testing::HasSubstr;

HitBuffer random_hits(int cols, int rows) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> values(-5000.0F, 5000.0F);
    HitBuffer hits(cols, rows);
    for (Hit& hit : hits.samples()) {
        if (random() % 3 != 0) {
            hit = {values(random),           values(random),         values(random),
                   std::abs(values(random)), 1e-7F * values(random), 1e-7F * values(random)};
        }
    }
    return hits;
}

TEST(HitFile, HoldsNoDateOfToday) {
    const test::TemporaryFolder folder;
    const auto path = folder.path() / "hit.exr";
    ASSERT_TRUE(write_hits(path, random_hits(8, 8)));
    EXPECT_THAT(test::read_bytes(path), HasSubstr("1970:01:01 00:00:00"));
}

TEST(HitFile, ComesBackToTheBitSkyIncluded) {
    const test::TemporaryFolder folder;
    const HitBuffer hits = random_hits(53, 31);
    const auto path = folder.path() / "hit.exr";
    const auto written = write_hits(path, hits);
    ASSERT_TRUE(written) << written.error().message;
    EXPECT_EQ(folder.names(), std::vector<std::string>{"hit.exr"});
    const auto again = read_hits(path);
    ASSERT_TRUE(again) << again.error().message;
    ASSERT_EQ(again->cols(), 53);
    ASSERT_EQ(again->rows(), 31);
    int sky = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const Hit& a = hits.samples()[i];
        const Hit& b = again->samples()[i];
        ASSERT_EQ(a.col, b.col);
        ASSERT_EQ(a.row, b.row);
        ASSERT_EQ(a.height, b.height);
        ASSERT_EQ(a.depth, b.depth);
        ASSERT_EQ(a.place(), b.place());
        sky += b.is_sky() ? 1 : 0;
    }
    EXPECT_GT(sky, 0);
}

TEST(HitFile, UnwritablePathsAreNamedAndLeaveNothing) {
    const test::TemporaryFolder folder;
    const HitBuffer hits = random_hits(4, 4);
    for (const auto& path : {folder.path() / "none" / "hit.exr", folder.path() / "hit.png"}) {
        const auto written = write_hits(path, hits);
        ASSERT_FALSE(written);
        EXPECT_THAT(written.error().message, HasSubstr(path.string() + ": cannot be written"));
    }
    EXPECT_FALSE(write_hits(folder.path() / "hit.exr", HitBuffer{}));
    EXPECT_TRUE(folder.names().empty());
}

TEST(HitFile, OtherPicturesAreNoHits) {
    const test::TemporaryFolder folder;
    ASSERT_TRUE(write_image(folder.path() / "a.png", Image(4, 4)));
    const auto hits = read_hits(folder.path() / "a.png");
    ASSERT_FALSE(hits);
    EXPECT_THAT(hits.error().message,
                HasSubstr("channels col, row, height, depth, col_low, row_low"));
    EXPECT_FALSE(read_hits(folder.path() / "none.exr"));
    EXPECT_FALSE(read_hits(folder.write("a.exr", "no EXR")));
}

TEST(HitFile, ACutFileIsAnError) {
    const test::TemporaryFolder folder;
    ASSERT_TRUE(write_hits(folder.path() / "hit.exr", random_hits(200, 200)));
    const std::string whole = test::read_bytes(folder.path() / "hit.exr");
    for (const std::size_t length : {std::size_t{4}, std::size_t{100}, whole.size() / 2}) {
        EXPECT_FALSE(read_hits(folder.write("cut.exr", whole.substr(0, length)))) << length;
    }
}

} // namespace
} // namespace reljef::io
