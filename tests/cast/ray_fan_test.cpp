#include "engine/cast/ray_fan.h"

#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/terrain/chance.h"

namespace reljef::cast {
namespace {

constexpr PixelBlock fan_block{{640, 352}, {32, 32}};

glm::dvec3 random_vector(test::Chance& chance, double size) {
    return {chance.between(-size, size), chance.between(-size, size), chance.between(-size, size)};
}

// Rays of second degree in the pixel, and of sixth degree in the depth.
class MadeRays {
public:
    explicit MadeRays(test::Chance& chance) {
        for (std::size_t power = 0; power < vectors_.size(); ++power) {
            PictureRays::Vectors& vectors = vectors_[power];
            const double size = std::pow(1e-3, static_cast<double>(power));
            vectors.first = random_vector(chance, 1e3 * size);
            vectors.right = random_vector(chance, size);
            vectors.down = random_vector(chance, size);
            for (glm::dvec3& bend : vectors.bends) {
                bend = random_vector(chance, 1e-3 * size);
            }
        }
    }
    [[nodiscard]] glm::dvec3 at(glm::dvec2 pixel, double t) const {
        glm::dvec3 sum(0.0);
        for (std::size_t power = vectors_.size(); power-- > 0;) {
            sum = sum * t + vectors_[power].at(pixel);
        }
        return sum;
    }

private:
    std::array<PictureRays::Vectors, 7> vectors_{};
};

glm::dvec2 random_pixel(test::Chance& chance) {
    return glm::dvec2(fan_block.first) +
           glm::dvec2(chance.between(0.0, 32.0), chance.between(0.0, 32.0));
}

TEST(RayFan, OfSecondDegreeIsThatOfRaysOfSecondDegree) {
    test::Chance chance(71);
    for (int round = 0; round < 300; ++round) {
        const MadeRays rays(chance);
        const auto sample_of = [&](glm::dvec2 pixel, double t) {
            return std::optional(rays.at(pixel, t));
        };
        const double t = chance.between(0.0, 900.0);
        const auto fan = ray_fan(fan_block, FanDegree::second, t, sample_of);
        ASSERT_TRUE(fan);
        EXPECT_LT(glm::length(fan->misfit), 1e-8);
        const auto linear = ray_fan(fan_block, FanDegree::linear, t, sample_of);
        ASSERT_TRUE(linear);
        EXPECT_GT(glm::length(linear->misfit), 1e-3);
        for (int i = 0; i < 30; ++i) {
            const glm::dvec2 pixel = random_pixel(chance);
            const glm::dvec3 sample = rays.at(pixel, t);
            EXPECT_LT(glm::distance(fan->vectors.at(pixel), sample), 1e-8);
            EXPECT_TRUE(glm::all(glm::greaterThanEqual(sample, fan->box.low - 1e-8)) &&
                        glm::all(glm::lessThanEqual(sample, fan->box.high + 1e-8)));
        }
    }
}

TEST(RayFan, OfATrackIsThatOfItsRays) {
    test::Chance chance(72);
    constexpr double unseen = 1e-7;
    const auto is_unseen = [](glm::dvec3 found, glm::dvec3 sample, double /*t*/) {
        return glm::length(found - sample) < unseen;
    };
    for (int round = 0; round < 300; ++round) {
        const MadeRays rays(chance);
        const auto sample_of = [&](glm::dvec2 pixel, double t) {
            return std::optional(rays.at(pixel, t));
        };
        const auto track =
            FanTrack::create(fan_block, FanDegree::second, {100.0, 800.0}, sample_of, is_unseen);
        ASSERT_TRUE(track);
        EXPECT_FALSE(track->has(99.0) || track->has(801.0));
        for (int i = 0; i < 10; ++i) {
            const double t = chance.between(100.0, 800.0);
            const glm::dvec2 pixel = random_pixel(chance);
            EXPECT_LT(glm::distance(track->fan(t).vectors.at(pixel), rays.at(pixel, t)), 1e-6);
        }
    }
}

TEST(RayFan, IsNoneWhereARayHasNoSample) {
    const auto sample_of = [](glm::dvec2 pixel, double /*t*/) {
        return pixel.x > 660.0 ? std::nullopt : std::optional(glm::dvec3(pixel, 0.0));
    };
    EXPECT_FALSE(ray_fan(fan_block, FanDegree::linear, 1.0, sample_of));
    const auto all_unseen = [](glm::dvec3 /*found*/, glm::dvec3 /*sample*/, double /*t*/) {
        return true;
    };
    EXPECT_FALSE(FanTrack::create(fan_block, FanDegree::linear, {1.0, 2.0}, sample_of, all_unseen));
}

TEST(RayFan, HasNoTrackWhereRaysBendTooMuch) {
    const auto sample_of = [](glm::dvec2 pixel, double t) {
        return std::optional(glm::dvec3(pixel.x, std::sin(t), 0.0));
    };
    const auto is_unseen = [](glm::dvec3 found, glm::dvec3 sample, double /*t*/) {
        return glm::length(found - sample) < 1e-4;
    };
    EXPECT_TRUE(FanTrack::create(fan_block, FanDegree::linear, {0.0, 1.0}, sample_of, is_unseen));
    EXPECT_FALSE(FanTrack::create(fan_block, FanDegree::linear, {0.0, 30.0}, sample_of, is_unseen));
}

} // namespace
} // namespace reljef::cast
