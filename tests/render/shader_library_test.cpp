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
    for (const ShaderKind kind : {ShaderKind::terrain, ShaderKind::mesh, ShaderKind::sky}) {
        for (std::uint32_t features = 0; features < 64; ++features) {
            const ShaderVariant variant = without_meaningless({kind, features & 7U});
            EXPECT_EQ(variant.kind, kind);
            EXPECT_NE(std::find(variants.begin(), variants.end(), variant), variants.end());
        }
    }
}

TEST(ShaderVariants, AHitHasNeitherLightNorFogAndTheSkyIsNeverHit) {
    for (const ShaderVariant& variant : all_variants()) {
        const bool hit = (variant.features & feature_hit) != 0;
        EXPECT_FALSE(hit && variant.features != feature_hit);
        EXPECT_FALSE(variant.kind == ShaderKind::sky && (variant.features & ~feature_lit) != 0);
    }
    // terrain: fog or not, or a hit; mesh: lit or not too; sky: lit or not.
    EXPECT_EQ(all_variants().size(), 3U + 5U + 2U);
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
