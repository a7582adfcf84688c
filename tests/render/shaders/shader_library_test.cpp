#include "engine/render/shaders/shader_library.h"

#include <algorithm>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "tests/render/shaders/all_variants.h"
#include "tests/support/text_pattern.h"

namespace reljef::render {
namespace {

TEST(ShaderVariants, AreEachThereOnceAndMeanSomething) {
    const auto& variants = all_variants();
    EXPECT_EQ(std::set(variants.begin(), variants.end()).size(), variants.size());
    for (const ShaderVariant& variant : variants) {
        EXPECT_EQ(canonical_variant(variant), variant);
    }
}

TEST(ShaderVariants, HoldWhateverAnyCombinationMeans) {
    const auto& variants = all_variants();
    for (const ShaderKind kind :
         {ShaderKind::terrain, ShaderKind::relief, ShaderKind::mesh, ShaderKind::textured_mesh,
          ShaderKind::relief_mesh, ShaderKind::relief_hull, ShaderKind::textured_terrain,
          ShaderKind::relief_terrain, ShaderKind::sky, ShaderKind::average,
          ShaderKind::sun_depth}) {
        for (ShaderFeatures features = 0; features < feature_counting << 1U; features += 121U) {
            const ShaderVariant variant = canonical_variant({kind, features});
            ASSERT_EQ(variant.kind, kind);
            ASSERT_TRUE(std::binary_search(variants.begin(), variants.end(), variant));
        }
    }
}

TEST(ShaderVariants, AHitHasNeitherLightNorFogAndTheSkyIsNeverHit) {
    std::size_t multisampled = 0;
    std::size_t colors = 0;
    std::size_t counted = 0;
    for (const ShaderVariant& variant : all_variants()) {
        constexpr ShaderFeatures looks = feature_lit | feature_fog;
        const bool hit = (variant.features & feature_hit) != 0;
        EXPECT_FALSE(hit && (variant.features & looks) != 0);
        EXPECT_FALSE(variant.kind == ShaderKind::sky &&
                     (variant.features & ~(looks | feature_sky_picture)) != 0);
        const bool is_multisampled = (variant.features & feature_multisampled) != 0;
        const bool counts = (variant.features & feature_counting) != 0;
        counted += counts ? 1U : 0U;
        EXPECT_FALSE(counts && (hit || is_multisampled || (variant.features & feature_fog) != 0));
        const bool has_color = !hit && !counts && variant.kind != ShaderKind::sky &&
                               variant.kind != ShaderKind::beams &&
                               variant.kind != ShaderKind::average &&
                               variant.kind != ShaderKind::sun_depth;
        multisampled += is_multisampled ? 1U : 0U;
        colors += has_color && !is_multisampled ? 1U : 0U;
    }
    // terrain: fog or not, or a hit; as it is, warped, or one of two kinds of slivers; mesh: lit or
    // not too; sky: lit or not, fog or not, a picture or not; the mean of pictures. relief, of four
    // parallaxes: each with and without fade and depth; of eight searches: these, and as colour
    // three shadows and smooth edges or not. All colours of a terrain but warped ones are there
    // with overlays, too, with façades or not. Of these, and of meshes, all colours are there with
    // point lights, too. Lit meshes, colours of terrains, lit tiles on them, and reliefs with
    // shadows, are there with shadows of meshes, too; and the depth that these are made from.
    constexpr std::size_t parallax = 4U * (1U + 2U * 6U) * 4U;
    constexpr std::size_t searches = 8U * (4U + 2U * 6U * 4U * 10U);
    // All of a relief are there for streams and on the ellipsoid, with degree 4 or not, too;
    // without beams, also for places that are mapped one by one.
    constexpr std::size_t spaces = 2U * 4U;
    constexpr std::size_t spaces_with_beams = 2U * 3U;
    // Three of the searches, without fade, are there with beams too; and the beams themselves.
    constexpr std::size_t beams = 1U + 3U * (2U + 2U * 6U * 2U * 10U);
    // A mesh with a tile: lit in four ways, warped or not; one that searches is that of a relief,
    // lit or not, wrapped or not; one that looks for layers has no smooth edges.
    constexpr std::size_t textured = 2U * (2U * (4U * 2U * 2U + 2U) + 2U);
    constexpr std::size_t mesh_parallax = 2U * 4U * (2U * 2U * (1U + 2U) + 1U) * 4U;
    constexpr std::size_t mesh_searches = 2U * 8U * (4U + 2U * 4U * 2U * 2U * (2U * 3U + 1U));
    constexpr std::size_t layers = 2U * (4U + 2U * 4U * 2U * (2U * 3U + 1U));
    // A hull is lit with three shadows or not at all, wrapped or not.
    // A terrain with a tile: lit in four ways or not; one that searches casts three shadows, or is
    // not lit; none is ever hit. Both kinds of slivers are there, too.
    constexpr std::size_t textured_ground = 2U * 3U * 2U * (2U * 4U + 1U);
    constexpr std::size_t hull_searches = 2U * 8U * (1U + 2U * 2U * (1U + 3U));
    constexpr std::size_t ground_searches = 2U * 3U * 2U * (4U * (1U + 2U) + 8U * (1U + 2U * 3U));
    constexpr std::size_t plain = 3U * 4U + 2U * 2U * 3U + 2U * 3U * 3U + 2U * 2U * 3U * 3U +
                                  2U * 4U + 1U + 4U + 1U + 2U * 2U * 2U + 1U;
    // What counts is a colour without air and depth: of a terrain, also warped or its two kinds of
    // slivers; of the beams; and of a relief, of four parallaxes with and without fade; of eight
    // searches with these, three shadows, and smooth edges or not; three of them with beams,
    // without fade.
    constexpr std::size_t counting =
        4U + spaces * (4U * 2U + 8U * 2U * 6U) + spaces_with_beams * (1U + 3U * 6U);
    EXPECT_EQ(counted, counting);
    EXPECT_EQ(all_variants().size() - multisampled - counted,
              plain + spaces * (parallax + searches) + spaces_with_beams * beams + textured +
                  mesh_parallax + mesh_searches + layers + textured_ground + ground_searches +
                  hull_searches);
    EXPECT_EQ(multisampled, colors) << "whatever a scene shows";
}

TEST(ShaderVariants, OptionsThatMeanNothingAreLeftOut) {
    constexpr ShaderFeatures shadows = feature_hard_shadow | feature_soft_shadow;
    for (const ShaderVariant& variant : all_variants()) {
        const auto has = [&](ShaderFeatures features) {
            return (variant.features & features) != 0;
        };
        constexpr ShaderFeatures options = shadows | feature_fade | feature_smooth_edges |
                                           feature_write_depth | feature_view_steps;
        EXPECT_FALSE(has(options) && variant.kind != ShaderKind::relief &&
                     variant.kind != ShaderKind::relief_mesh &&
                     variant.kind != ShaderKind::relief_hull &&
                     variant.kind != ShaderKind::relief_terrain);
        EXPECT_FALSE(has(feature_parallax | feature_hit) && has(shadows | feature_smooth_edges));
        EXPECT_FALSE(has(feature_parallax | feature_exact | feature_cone) &&
                     has(feature_view_steps));
        EXPECT_FALSE(has(feature_hard_shadow) && has(feature_soft_shadow));
        EXPECT_FALSE(has(shadows) && !has(feature_lit)) << "a shadow without a sun";
    }
}

TEST(ShaderVariants, AReliefLooksForItsSurfaceInOneWay) {
    for (const ShaderVariant& variant : all_variants()) {
        int ways = 0;
        for (const ShaderFeatures way : {feature_exact, feature_cone, feature_layers,
                                         feature_parallax, feature_bisect, feature_secant}) {
            ways += (variant.features & way) != 0 ? 1 : 0;
        }
        const bool searches =
            variant.kind == ShaderKind::relief || variant.kind == ShaderKind::relief_mesh ||
            variant.kind == ShaderKind::relief_hull || variant.kind == ShaderKind::relief_terrain;
        EXPECT_LE(ways, searches ? 1 : 0);
    }
}

TEST(EmbeddedShaders, HaveNamesAndTexts) {
    std::set<std::string_view> names;
    for (const EmbeddedShader& shader : embedded_shaders()) {
        EXPECT_TRUE(names.insert(shader.name).second);
        EXPECT_FALSE(shader.text.empty()) << shader.name;
    }
    EXPECT_TRUE(names.contains("terrain/terrain.vert"));
    EXPECT_TRUE(names.contains("frame/frame_block.inc"));
}

TEST(EmbeddedShaders, NameTheBindingsOfAllBlocksAndMaps) {
    std::string bindings;
    std::string others;
    for (const EmbeddedShader& shader : embedded_shaders()) {
        (shader.name == "frame/bindings.inc" ? bindings : others) += shader.text;
    }
    EXPECT_TRUE(test::matches(others, R"(binding\s*=\s*\d)").empty());
    for (const auto& map : test::matches(others, R"((.*)uniform sampler2D (\w+))")) {
        EXPECT_NE(map[1].find("_unit)"), std::string::npos) << map[0];
    }
    for (const auto& constant : test::matches(bindings, R"(const u?int (\w+) =)")) {
        EXPECT_NE(others.find(constant[1]), std::string::npos) << constant[1];
    }
}

} // namespace
} // namespace reljef::render
