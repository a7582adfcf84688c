#include "engine/cast/picture_samples.h"

#include <array>
#include <functional>
#include <set>
#include <utility>

#include <glm/common.hpp>
#include <gtest/gtest.h>

#include "engine/cast/simd_target.h"

namespace reljef::cast {
namespace {

constexpr glm::ivec2 picture_size{40, 35};
constexpr int step_col = 20; // behind it the surface is nearer

// Beside each pixel are other colours.
FirstSamples checked() {
    FirstSamples first;
    first.resize(picture_size);
    first.disagreement = 1e-3F;
    for (int row = 0; row < picture_size.y; ++row) {
        for (int col = 0; col < picture_size.x; ++col) {
            const auto level = static_cast<std::uint8_t>((col + row) % 2 * 200);
            first.picture(col, row) = {level, level, level, 255};
        }
    }
    return first;
}

constexpr std::array<glm::ivec2, 4> block_begins{glm::ivec2(0, 0), {32, 0}, {0, 32}, {32, 32}};

PixelBlock block_at(glm::ivec2 begin) {
    return {begin, glm::min(picture_size - begin, glm::ivec2(block_side))};
}

// Adds `nearness` of each pixel, also of those beside the picture.
void add_nearness(const BlockKernel& kernel, const std::function<float(glm::ivec2)>& nearness,
                  FirstSamples& first) {
    for (const glm::ivec2 begin : block_begins) {
        BlockPixels pixels;
        for (int i = 0; i < static_cast<int>(block_pixels); ++i) {
            pixels.nearness[static_cast<std::size_t>(i)] =
                nearness(begin + glm::ivec2(i % block_side, i / block_side));
        }
        first.add_nearness(pixels, block_at(begin), {{0, 0}, picture_size}, kernel);
    }
}

// A plane with a step; beside the picture it is elsewhere.
float stepped(glm::ivec2 pixel, float step) {
    const bool is_beside = pixel.x >= picture_size.x || pixel.y >= picture_size.y;
    const float plane =
        1.0F + 0.25F * static_cast<float>(pixel.x) + 0.5F * static_cast<float>(pixel.y);
    return plane + (pixel.x >= step_col ? step : 0.0F) + (is_beside ? 1e6F : 0.0F);
}

// In all blocks.
std::set<std::pair<int, int>> sampled(const FirstSamples& first, const BlockKernel& kernel) {
    std::set<std::pair<int, int>> found;
    for (const glm::ivec2 begin : block_begins) {
        for (const int pixel : sampled_pixels(first, kernel, block_at(begin))) {
            found.insert({begin.x + pixel % block_side, begin.y + pixel / block_side});
        }
    }
    return found;
}

std::size_t count_sampled(float step, const SimdTarget& target, bool has_one_color = false) {
    const BlockKernel kernel = block_kernel(target.bit);
    FirstSamples first = checked();
    add_nearness(
        kernel, [&](glm::ivec2 pixel) { return stepped(pixel, step); }, first);
    if (has_one_color) {
        first.picture = Image(picture_size.x, picture_size.y, Rgba8{9, 9, 9, 255});
    }
    return sampled(first, kernel).size();
}

TEST(PictureSamples, APlaneNeedsNoneAlsoAtTheBordersOfThePicture) {
    for (const SimdTarget& target : simd_targets()) {
        EXPECT_EQ(count_sampled(0.0F, target), 0U) << target.name;
    }
}

TEST(PictureSamples, BothSidesOfAStepNeedThem) {
    for (const SimdTarget& target : simd_targets()) {
        EXPECT_EQ(count_sampled(1.0F, target), 2U * picture_size.y) << target.name;
        EXPECT_EQ(count_sampled(1.0F, target, true), 0U) << target.name << ", one colour";
    }
}

// The middles of three pixels in line that hold this one, and of which none is beside the picture.
std::set<std::pair<int, int>> middles_around(glm::ivec2 pixel) {
    std::set<std::pair<int, int>> middles;
    for (const glm::ivec2 axis : {glm::ivec2(1, 0), glm::ivec2(0, 1)}) {
        for (int step = -1; step <= 1; ++step) {
            const glm::ivec2 middle = pixel + step * axis;
            const glm::ivec2 low = middle - axis;
            const glm::ivec2 high = middle + axis;
            if (glm::min(low, glm::ivec2(0)) == glm::ivec2(0) &&
                glm::max(high, picture_size - 1) == picture_size - 1) {
                middles.insert({middle.x, middle.y});
            }
        }
    }
    return middles;
}

// Also across the borders of blocks, at all places.
TEST(PictureSamples, ThePixelsAroundANearerOneNeedThem) {
    for (const SimdTarget& target : simd_targets()) {
        const BlockKernel kernel = block_kernel(target.bit);
        for (int i = 0; i < picture_size.x * picture_size.y; ++i) {
            const glm::ivec2 near(i % picture_size.x, i / picture_size.x);
            FirstSamples first = checked();
            add_nearness(
                kernel, [&](glm::ivec2 pixel) { return pixel == near ? 2.0F : 1.0F; }, first);
            ASSERT_EQ(sampled(first, kernel), middles_around(near))
                << target.name << ' ' << near.x << ' ' << near.y;
        }
    }
}

TEST(PictureSamples, AllPixelsCanHaveThem) {
    FirstSamples first = checked();
    first.samples_all = true;
    EXPECT_EQ(sampled(first, block_kernel(SimdTarget{}.bit)).size(),
              static_cast<std::size_t>(picture_size.x * picture_size.y));
}

} // namespace
} // namespace reljef::cast
