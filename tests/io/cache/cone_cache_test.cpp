#include "engine/io/cache/disk_cache.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/io/cache/resealed.h"
#include "tests/support/temporary_folder.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::io {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

class ConeCache : public testing::Test {
protected:
    Cached<material::ConeMaps> cones() {
        return cached_cones(
                   heights_.view(),
                   {.folder = folder_.path() / "cache", .min_seconds = 0.0, .parallel = {}})
            .value();
    }
    [[nodiscard]] std::filesystem::path file() const {
        return cone_file(folder_.path() / "cache", heights_.view());
    }
    // As made, and kept again after `bytes` were found.
    void expect_rebuilt_from(const std::string& bytes, const std::string& found) {
        static_cast<void>(folder_.write("cache/" + file().filename().string(), bytes));
        const Cached<material::ConeMaps> again = cones();
        EXPECT_THAT(again.note, HasSubstr(found));
        EXPECT_EQ(again.value->plain, made_->plain);
        EXPECT_EQ(test::read_bytes(file()), good_);
        EXPECT_THAT(cones().note, IsEmpty());
    }
    void SetUp() override {
        made_ = cones().value;
        good_ = test::read_bytes(file());
    }

    test::TemporaryFolder folder_;
    Grid<float> heights_ = test::random_heights(20, 13, 0.0F, 1.0F, 1);
    std::shared_ptr<const material::ConeMaps> made_;
    std::string good_;
};

TEST_F(ConeCache, WhatIsReadIsWhatWasMade) {
    const Cached<material::ConeMaps> again = cones();
    EXPECT_THAT(again.note, IsEmpty());
    EXPECT_EQ(again.value->plain, made_->plain);
    EXPECT_EQ(again.value->relaxed, made_->relaxed);
}

TEST_F(ConeCache, ItIsReadAndNotMadeAgain) {
    std::stop_source stopped;
    stopped.request_stop();
    const auto again = cached_cones(
        heights_.view(), {.folder = folder_.path() / "cache",
                          .min_seconds = 0.0,
                          .parallel = {.threads = 0, .stop = stopped.get_token(), .progress = {}}});
    EXPECT_TRUE(again);
    heights_(3, 3) = 0.5F;
    EXPECT_FALSE(
        cached_cones(heights_.view(),
                     {.folder = folder_.path() / "cache",
                      .min_seconds = 0.0,
                      .parallel = {.threads = 0, .stop = stopped.get_token(), .progress = {}}}));
}

TEST_F(ConeCache, ACutFileIsMadeAnewAndToldOnce) {
    expect_rebuilt_from(good_.substr(0, good_.size() / 2), "a length of");
    expect_rebuilt_from("", "a length of 0 bytes");
    expect_rebuilt_from(good_ + 'x', "a length of");
}

TEST_F(ConeCache, AnotherVersionIsMadeAnewAndToldOnce) {
    std::string other = good_;
    other[8] = 77;
    expect_rebuilt_from(other, "version 77");
}

TEST_F(ConeCache, AFlippedBitAnywhereIsFound) {
    for (std::size_t at = 0; at < good_.size(); at += 101) {
        std::string flipped = good_;
        flipped[at] = static_cast<char>(flipped[at] ^ 4);
        expect_rebuilt_from(flipped, " found, the cones of these heights");
    }
}

// Plain cones, then relaxed ones.
TEST_F(ConeCache, NonsenseBehindAValidChecksumIsFound) {
    const std::vector<std::function<void(std::span<float>)>> changes{
        [](std::span<float> numbers) { numbers[0] = 0.0F; },
        [](std::span<float> numbers) { numbers[7] = -1.0F; },
        [](std::span<float> numbers) { numbers[7] = std::nanf(""); },
        [](std::span<float> numbers) { numbers.back() = 1.001F * material::max_cone_ratio; },
        [](std::span<float> numbers) { std::fill(numbers.begin(), numbers.end(), 1.0F); },
        [](std::span<float> numbers) { std::reverse(numbers.begin(), numbers.end()); },
        [](std::span<float> numbers) {
            for (float& ratio : numbers) {
                ratio *= 0.9999F;
            }
        },
    };
    for (const auto& change : changes) {
        expect_rebuilt_from(test::resealed<float>(good_, change), "nonsense found");
    }
}

// The check must not reject what was made, whatever the roundings.
TEST_F(ConeCache, RightConesAreNeverNonsense) {
    for (const std::uint32_t seed : {1U, 2U, 3U}) {
        const Grid<float> rough = test::random_heights(70, 45, 0.0F, 1.0F, seed);
        EXPECT_TRUE(material::are_cones_of(*material::cone_maps(rough.view()), rough.view()));
    }
    for (const glm::ivec2 size : {glm::ivec2(2, 2), glm::ivec2(2, 40), glm::ivec2(300, 3)}) {
        const Grid<float> flat(size.x, size.y, 0.5F);
        EXPECT_TRUE(material::are_cones_of(*material::cone_maps(flat.view()), flat.view()));
    }
}

TEST_F(ConeCache, TheConesOfOtherHeightsAreNotTaken) {
    const std::string others = good_;
    heights_(5, 5) += 0.25F;
    static_cast<void>(folder_.write("cache/" + file().filename().string(), others));
    EXPECT_THAT(cones().note, HasSubstr("a wrong checksum"));
}

TEST_F(ConeCache, WithoutAPlaceToKeepThemTheyAreMade) {
    const auto in_no_folder = cached_cones(heights_.view(), {}).value();
    EXPECT_EQ(in_no_folder.value->plain, made_->plain);
    static_cast<void>(folder_.write("taken", "a file"));
    const auto in_a_file =
        cached_cones(heights_.view(),
                     {.folder = folder_.path() / "taken", .min_seconds = 0.0, .parallel = {}})
            .value();
    EXPECT_EQ(in_a_file.value->plain, made_->plain);
    EXPECT_THAT(in_a_file.note, HasSubstr("taken: cannot be used"));
}

TEST_F(ConeCache, WhatIsMadeAtOnceIsNotKept) {
    const auto folder_of_none = folder_.path() / "none";
    static_cast<void>(cached_cones(heights_.view(),
                                   {.folder = folder_of_none, .min_seconds = 1e9, .parallel = {}}));
    EXPECT_FALSE(std::filesystem::exists(folder_of_none));
}

} // namespace
} // namespace reljef::io
