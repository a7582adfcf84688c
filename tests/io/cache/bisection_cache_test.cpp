#include "engine/io/cache/disk_cache.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/io/cache/resealed.h"
#include "tests/support/process_state.h"
#include "tests/support/temporary_folder.h"
#include "tests/terrain/made_bisection.h"

namespace reljef::io {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

// Of every split in a square, and of those on sides by their bounds.
void expect_same_splits(const terrain::Bisection& found, const terrain::Bisection& expected) {
    ASSERT_EQ(found.end(), expected.end());
    for (int size = 2 * terrain::steps_per_sample; size < 128 * terrain::steps_per_sample;
         size *= 2) {
        for (std::int64_t y = size / 2; y <= expected.end().y; y += size) {
            for (std::int64_t x = size / 2; x <= expected.end().x; x += size) {
                const terrain::Split a = found.split({x, y}, size, false);
                const terrain::Split b = expected.split({x, y}, size, false);
                EXPECT_EQ(std::tie(a.error, a.radius), std::tie(b.error, b.radius));
                EXPECT_EQ(a.center, b.center);
            }
        }
    }
    EXPECT_EQ(found.bounds(), expected.bounds());
    EXPECT_EQ(found.height({7, 9}), expected.height({7, 9}));
}

class BisectionCache : public testing::Test {
protected:
    [[nodiscard]] CacheOptions options() const {
        return {.folder = folder_.path() / "cache", .min_seconds = 0.0, .parallel = {}};
    }
    [[nodiscard]] std::optional<Cached<terrain::Bisection>> cached(const CacheOptions& with) const {
        return cached_bisection(terrain_.heightfield, terrain_.placement, with);
    }
    [[nodiscard]] Cached<terrain::Bisection> cached() const { return cached(options()).value(); }
    [[nodiscard]] std::filesystem::path file() const {
        return bisection_file(folder_.path() / "cache", terrain_.heightfield, terrain_.placement);
    }
    // As made, and kept again after `bytes` were found.
    void expect_rebuilt_from(const std::string& bytes, const std::string& found) {
        static_cast<void>(folder_.write("cache/" + file().filename().string(), bytes));
        const Cached<terrain::Bisection> again = cached();
        EXPECT_THAT(again.note, HasSubstr(found));
        EXPECT_EQ(again.value->bounds(), terrain_.bisection.bounds());
        EXPECT_EQ(test::read_bytes(file()), good_);
        EXPECT_THAT(cached().note, IsEmpty());
    }
    void SetUp() override {
        static_cast<void>(cached());
        good_ = test::read_bytes(file());
    }

    test::TemporaryFolder folder_;
    test::PlacedTerrain terrain_{
        {"hills", test::plane_heightfield(test::rough_hills(90, 61, 1), {30.0, 40.0}), 2.0}};
    std::string good_;
};

TEST_F(BisectionCache, WhatIsReadIsWhatWasMade) {
    const Cached<terrain::Bisection> again = cached();
    EXPECT_THAT(again.note, IsEmpty());
    expect_same_splits(*again.value, terrain_.bisection);
}

TEST_F(BisectionCache, OnTheEarthTheSame) {
    const test::PlacedTerrain bent{
        {"bent", test::geographic_heightfield(test::rough_hills(60, 140, 2), 46.0, 7.0, 1e-3)}};
    for (int i = 0; i < 2; ++i) { // made, and read
        const auto made = cached_bisection(bent.heightfield, bent.placement, options());
        EXPECT_THAT(made->note, IsEmpty());
        expect_same_splits(*made->value, bent.bisection);
    }
}

TEST_F(BisectionCache, ItIsReadAndNotMadeAgain) {
    const auto written = std::filesystem::last_write_time(file());
    static_cast<void>(cached());
    EXPECT_EQ(std::filesystem::last_write_time(file()), written);
}

TEST_F(BisectionCache, ACutFileIsMadeAnewAndToldOnce) {
    expect_rebuilt_from(good_.substr(0, good_.size() / 2), "a length of");
    expect_rebuilt_from("", "a length of 0 bytes");
    expect_rebuilt_from(good_ + 'x', "a length of");
}

TEST_F(BisectionCache, AnotherVersionIsMadeAnewAndToldOnce) {
    std::string other = good_;
    other[8] = 77;
    expect_rebuilt_from(other, "version 77");
}

TEST_F(BisectionCache, AFlippedBitAnywhereIsFound) {
    for (std::size_t at = 0; at < good_.size(); at += 7919) {
        std::string flipped = good_;
        flipped[at] = static_cast<char>(flipped[at] ^ 4);
        expect_rebuilt_from(flipped, " found, the error bounds of these heights");
    }
}

TEST_F(BisectionCache, NonsenseBehindAValidChecksumIsFound) {
    using terrain::SplitBounds;
    using terrain::UpperBound;
    using Bounds = std::span<SplitBounds>;
    const auto no_number = UpperBound::from_bits(0xffff);
    const UpperBound infinite(std::numeric_limits<double>::infinity());
    const std::vector<std::function<void(Bounds)>> changes{
        [](Bounds bounds) { std::fill(bounds.begin(), bounds.end(), SplitBounds()); },
        [&](Bounds bounds) { bounds[0].error = no_number; },
        [&](Bounds bounds) { bounds[0].radius = no_number; },
        [&](Bounds bounds) { bounds[50].radius = infinite; },
        [](Bounds bounds) { // not nested
            for (SplitBounds& split : bounds) {
                split.radius = UpperBound(0.5 * split.radius.value());
            }
        },
        [](Bounds bounds) { std::reverse(bounds.begin(), bounds.end()); },
        [](Bounds bounds) { // nested and in range, but of no heights
            for (SplitBounds& split : bounds) {
                split.error = UpperBound(split.error.value() + 1.0);
            }
        },
    };
    for (const auto& change : changes) {
        expect_rebuilt_from(test::resealed<SplitBounds>(good_, change), "nonsense found");
    }
}

// A checksum is the seed, so that what one content hides, another shows.
TEST_F(BisectionCache, NonsenseOfNoSplitEscapesEverySeed) {
    const std::vector<terrain::SplitBounds> good = terrain_.bisection.bounds();
    for (const std::size_t wrong : {std::size_t{0}, good.size() / 2}) {
        std::vector<terrain::SplitBounds> bad = good;
        bad[wrong].error = terrain::UpperBound(bad[wrong].error.value() + 1.0);
        const terrain::Bisection bisection(terrain_.heightfield, terrain_.placement, bad);
        int found = 0;
        for (std::uint32_t seed = 0; seed < 512; ++seed) {
            found += bisection.is_valid(seed) ? 0 : 1;
        }
        EXPECT_GT(found, 0) << wrong;
    }
}

TEST_F(BisectionCache, APipeInPlaceOfTheFileDoesNotBlock) {
    std::filesystem::remove(file());
    ASSERT_EQ(::mkfifo(file().c_str(), 0600), 0);
    const Cached<terrain::Bisection> made = cached();
    EXPECT_THAT(made.note, HasSubstr("no regular file found"));
    expect_same_splits(*made.value, terrain_.bisection);
}

TEST_F(BisectionCache, ThatOfOtherHeightsOrPlacesIsNotTaken) {
    const auto name = file();
    const auto placed_otherwise =
        terrain::Placement::create(terrain_.heightfield, terrain::PlacementKind::plane, 2.5);
    EXPECT_NE(bisection_file(folder_.path() / "cache", terrain_.heightfield, *placed_otherwise),
              name);
    terrain_.heightfield.heights(5, 5) += 0.25F;
    EXPECT_NE(file(), name);
    static_cast<void>(folder_.write("cache/" + file().filename().string(), good_));
    EXPECT_THAT(cached().note, HasSubstr("a wrong checksum"));
}

TEST_F(BisectionCache, WithoutAPlaceToKeepItItIsMade) {
    const Cached<terrain::Bisection> in_no_folder = cached(CacheOptions{}).value();
    expect_same_splits(*in_no_folder.value, terrain_.bisection);
    EXPECT_THAT(in_no_folder.note, IsEmpty());
    static_cast<void>(folder_.write("taken", "a file"));
    CacheOptions in_a_file = options();
    in_a_file.folder = folder_.path() / "taken";
    EXPECT_THAT(cached(in_a_file).value().note, HasSubstr("taken: cannot be used"));
}

TEST_F(BisectionCache, WithoutRoomItIsMadeAndNothingIsLeft) {
    std::filesystem::remove(file());
    std::optional<Cached<terrain::Bisection>> made;
    {
        const test::FileSizeLimit limit(1000);
        made = cached(options());
    }
    EXPECT_THAT(made->note, HasSubstr("cannot be written"));
    expect_same_splits(*made->value, terrain_.bisection);
    EXPECT_TRUE(std::filesystem::is_empty(folder_.path() / "cache"));
}

TEST_F(BisectionCache, WhatIsStoppedLeavesNothing) {
    std::filesystem::remove(file());
    std::stop_source stopped;
    CacheOptions stopping = options();
    stopping.parallel.stop = stopped.get_token();
    stopping.parallel.progress = [&](double) { stopped.request_stop(); };
    EXPECT_FALSE(cached(stopping));
    EXPECT_TRUE(std::filesystem::is_empty(folder_.path() / "cache"));
}

TEST_F(BisectionCache, WhatIsMadeAtOnceIsNotKept) {
    std::filesystem::remove(file());
    CacheOptions patient = options();
    patient.min_seconds = 1e9;
    EXPECT_TRUE(cached(patient));
    EXPECT_FALSE(std::filesystem::exists(file()));
}

} // namespace
} // namespace reljef::io
