#include "bench/objects/city_heights.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace reljef::bench {
namespace {

using testing::HasSubstr;

terrain::Heightfield level(int cols, int rows, float height) {
    terrain::Heightfield field;
    field.heights = Grid<float>(cols, rows, height);
    field.spacing = {2.0, 2.0};
    return field;
}

TEST(ScanDifference, CountsWhatIsFartherOffThanASample) {
    terrain::Heightfield scanned = level(10, 10, 5.0F);
    scanned.heights(3, 4) = 9.0F;
    scanned.heights(7, 2) = 6.0F; // within a spacing
    const std::string text = scan_difference("town", scanned, level(10, 10, 5.0F));
    EXPECT_THAT(text, HasSubstr("town: ")); // √(17 / 100) m
    EXPECT_THAT(text, HasSubstr("by 0.412 m RMS, and by more than 2 m at 1.0 % of the samples"));
}

TEST(ScanDifference, VoidsOfTheScanAreLeftOut) {
    terrain::Heightfield scanned = level(10, 10, 5.0F);
    scanned.heights(3, 4) = 900.0F;
    scanned.void_mask = Grid<std::uint8_t>(10, 10);
    scanned.void_mask(3, 4) = 1;
    EXPECT_THAT(scan_difference("town", scanned, level(10, 10, 5.0F)), HasSubstr("by 0 m RMS"));
}

TEST(ScanDifference, GridsOfTwoSizesAreNotCompared) {
    EXPECT_THAT(scan_difference("town", level(10, 11, 5.0F), level(10, 10, 5.0F)),
                HasSubstr("10x11 samples found, 10x10 as of the ground were expected"));
}

} // namespace
} // namespace reljef::bench
