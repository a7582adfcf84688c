#include "engine/render/shaders/relief_options.h"

#include <array>
#include <bit>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace reljef::render {
namespace {

using Values = std::array<float, sizeof(TechniqueBlock) / sizeof(float)>;

Values values_of(const TechniqueBlock& block) {
    return std::bit_cast<Values>(block);
}

Values block_of(const scene::Technique& technique) {
    return values_of(technique_block(technique, 0.25));
}

TEST(TechniqueBlock, HoldsTheParametersOfASearchInMembersOfTheirOwn) {
    TechniqueBlock relief{};
    relief.linear_steps = 12.0F;
    relief.bisection_steps = 7.0F;
    EXPECT_EQ(block_of({scene::Relief{.linear_steps = 12, .bisection_steps = 7}}),
              values_of(relief));
    EXPECT_EQ(block_of({scene::Lattice{.linear_steps = 12, .bisection_steps = 7}}),
              values_of(relief));
    TechniqueBlock interval{};
    interval.linear_steps = 12.0F;
    interval.secant_steps = 7.0F;
    EXPECT_EQ(block_of({scene::Interval{.linear_steps = 12, .secant_steps = 7}}),
              values_of(interval));
    TechniqueBlock pom{};
    pom.secant_steps = 1.0F;
    pom.steps_from_above = 3.0F;
    pom.steps_along_ground = 40.0F;
    EXPECT_EQ(block_of({scene::Pom{.min_steps = 3, .max_steps = 40}}), values_of(pom));
    TechniqueBlock cone{};
    cone.cone_relaxed = 1.0F;
    cone.cone_max_steps = 30.0F;
    cone.bisection_steps = 2.0F;
    cone.cone_min_step = 0.5F;
    EXPECT_EQ(block_of({scene::Cone{
                  .relaxed = true, .max_steps = 30, .bisection_steps = 2, .min_step = 0.5}}),
              values_of(cone));
}

TEST(TechniqueBlock, HoldsTheParametersOfTheOthersInMembersOfTheirOwn) {
    TechniqueBlock parallax{};
    parallax.parallax_offset = -0.25F;
    EXPECT_EQ(block_of({scene::ParallaxLimited{.offset = -0.25}}), values_of(parallax));
    parallax.parallax_iterations = 5.0F;
    EXPECT_EQ(block_of({scene::ParallaxIterated{.offset = -0.25, .iterations = 5}}),
              values_of(parallax));
    TechniqueBlock emboss{};
    emboss.emboss_delta = 2.5F;
    EXPECT_EQ(block_of({scene::Emboss{.delta = 2.5}}), values_of(emboss));
    EXPECT_EQ(block_of({scene::Exact{}}), Values{});
}

TEST(TechniqueBlock, HoldsTheOptionsBesideTheParameters) {
    scene::Technique technique{scene::Steep{.linear_steps = 9}};
    technique.options.steps = scene::StepRange{.low = 4, .high = 16};
    technique.options.fade = scene::Fade{.low = 0.5, .high = 0.75, .power = 3.0};
    technique.options.shadow = scene::Shadow{.depth = 0.125};
    technique.options.smooth_edges = scene::SmoothEdges{.distance = 0.0625};
    TechniqueBlock expected{};
    expected.linear_steps = 9.0F;
    expected.steps_from_above = 4.0F;
    expected.steps_along_ground = 16.0F;
    expected.fade_low = 0.5F;
    expected.fade_high = 0.75F;
    expected.fade_power = 3.0F;
    expected.fade_reference_height = 0.25F;
    expected.shadow_depth = 0.125F;
    expected.edge_distance = 0.0625F;
    EXPECT_EQ(block_of(technique), values_of(expected));
}

} // namespace
} // namespace reljef::render
