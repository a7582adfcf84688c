#include "engine/render/shader_library.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

namespace reljef::render {
namespace {

TEST(ShaderVariants, AreEachThereOnceAndMeanSomething) {
    const auto variants = all_variants();
    EXPECT_EQ(std::set(variants.begin(), variants.end()).size(), variants.size());
    for (const ShaderVariant& variant : variants) {
        EXPECT_EQ(without_meaningless(variant), variant);
    }
}

TEST(ShaderVariants, HoldWhateverAnyCombinationMeans) {
    const auto variants = all_variants();
    for (const ShaderKind kind :
         {ShaderKind::terrain, ShaderKind::relief, ShaderKind::mesh, ShaderKind::sky}) {
        for (std::uint32_t features = 0; features < 2048; ++features) {
            const ShaderVariant variant = without_meaningless({kind, features});
            EXPECT_EQ(variant.kind, kind);
            EXPECT_NE(std::find(variants.begin(), variants.end(), variant), variants.end());
        }
    }
}

TEST(ShaderVariants, AHitHasNeitherLightNorFogAndTheSkyIsNeverHit) {
    for (const ShaderVariant& variant : all_variants()) {
        constexpr std::uint32_t looks = feature_lit | feature_fog;
        const bool hit = (variant.features & feature_hit) != 0;
        EXPECT_FALSE(hit && (variant.features & looks) != 0);
        EXPECT_FALSE(variant.kind == ShaderKind::sky && (variant.features & ~feature_lit) != 0);
    }
    // terrain: fog or not, or a hit; relief: each of ten searches so; mesh: lit or not too; sky:
    // lit or not.
    EXPECT_EQ(all_variants().size(), 3U + 10U * 3U + 5U + 2U);
}

TEST(ShaderVariants, AReliefLooksForItsSurfaceInOneWay) {
    for (const ShaderVariant& variant : all_variants()) {
        int ways = 0;
        for (const std::uint32_t way :
             {feature_exact, feature_cone, feature_parallax, feature_bisect, feature_secant}) {
            ways += (variant.features & way) != 0 ? 1 : 0;
        }
        EXPECT_LE(ways, variant.kind == ShaderKind::relief ? 1 : 0);
    }
}

TEST(EmbeddedShaders, HaveNamesAndTexts) {
    std::set<std::string_view> names;
    for (const EmbeddedShader& shader : embedded_shaders()) {
        EXPECT_TRUE(names.insert(shader.name).second);
        EXPECT_FALSE(shader.text.empty()) << shader.name;
    }
    EXPECT_TRUE(names.contains("terrain.vert"));
    EXPECT_TRUE(names.contains("frame_block.inc"));
}

} // namespace
} // namespace reljef::render
