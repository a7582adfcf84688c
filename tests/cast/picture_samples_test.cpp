#include "engine/cast/picture_samples.h"

#include <glm/common.hpp>
#include <gtest/gtest.h>

#include "engine/cast/simd_target.h"

namespace reljef::cast {
namespace {

constexpr glm::ivec2 picture_size{40, 35};
constexpr int step_col = 20; // behind it the surface is nearer

// A plane with a step; beside each pixel are other colours.
FirstSamples stepped(float step) {
    FirstSamples first;
    first.resize(picture_size);
    first.disagreement = 1e-3F;
    for (int row = 0; row < picture_size.y; ++row) {
        for (int col = 0; col < picture_size.x; ++col) {
            const float plane =
                1.0F + 0.25F * static_cast<float>(col) + 0.5F * static_cast<float>(row);
            *first.nearness_at({col, row}) = plane + (col >= step_col ? step : 0.0F);
            const auto level = static_cast<std::uint8_t>((col + row) % 2 * 200);
            first.picture(col, row) = {level, level, level, 255};
        }
    }
    return first;
}

// Of both columns of blocks and both rows.
int count_sampled(const FirstSamples& first, const SimdTarget& target) {
    const BlockKernel kernel = block_kernel(target.bit);
    int count = 0;
    for (const glm::ivec2 begin : {glm::ivec2(0, 0), {32, 0}, {0, 32}, {32, 32}}) {
        SampledPixels sampled;
        choose_sampled(first, kernel,
                       {begin, glm::min(picture_size - begin, glm::ivec2(block_side))}, sampled);
        count += sampled.count;
    }
    return count;
}

TEST(PictureSamples, APlaneNeedsNoneAlsoAtTheBordersOfThePicture) {
    for (const SimdTarget& target : simd_targets()) {
        EXPECT_EQ(count_sampled(stepped(0.0F), target), 0) << target.name;
    }
}

TEST(PictureSamples, BothSidesOfAStepNeedThem) {
    for (const SimdTarget& target : simd_targets()) {
        FirstSamples first = stepped(1.0F);
        EXPECT_EQ(count_sampled(first, target), 2 * picture_size.y) << target.name;
        first.picture = Image(picture_size.x, picture_size.y, Rgba8{9, 9, 9, 255});
        EXPECT_EQ(count_sampled(first, target), 0) << target.name << ", one colour";
    }
}

TEST(PictureSamples, AllPixelsCanHaveThem) {
    FirstSamples first = stepped(0.0F);
    first.samples_all = true;
    EXPECT_EQ(count_sampled(first, SimdTarget{}), picture_size.x * picture_size.y);
}

} // namespace
} // namespace reljef::cast
