#pragma once

#include <cstdint>
#include <set>
#include <unordered_set>
#include <vector>

#include "engine/render/shaders/shader_library.h"

namespace reljef::render {

/// The features that may have an effect on a kind, alone or with others.
inline ShaderFeatures possible_features(ShaderKind kind) {
    constexpr ShaderFeatures any = feature_lit | feature_fog | feature_hit;
    constexpr ShaderFeatures search = feature_exact | feature_parallax | feature_bisect |
                                      feature_secant | feature_limited | feature_iterated |
                                      feature_view_steps | feature_cone;
    constexpr ShaderFeatures relief = search | feature_fade | feature_hard_shadow |
                                      feature_soft_shadow | feature_smooth_edges |
                                      feature_write_depth;
    switch (kind) {
    case ShaderKind::terrain:
        return any | feature_warped | feature_multisampled | feature_counting | feature_sliver |
               feature_corner_depth | feature_overlay | feature_facades | feature_point_lights |
               feature_mesh_shadows;
    case ShaderKind::mesh:
        return any | feature_multisampled | feature_point_lights | feature_mesh_shadows;
    case ShaderKind::relief:
        return any | relief | feature_beams | feature_multisampled | feature_streamed |
               feature_curved | feature_quartic | feature_counting | feature_overlay |
               feature_facades | feature_point_lights | feature_mesh_shadows;
    case ShaderKind::beams:
        return any | feature_streamed | feature_curved | feature_quartic | feature_counting;
    case ShaderKind::relief_mesh:
        return any | relief | feature_layers | feature_wrap | feature_multisampled |
               feature_point_lights | feature_mesh_shadows;
    case ShaderKind::textured_mesh:
        return any | feature_normal_map | feature_bump | feature_emboss | feature_wrap |
               feature_warped | feature_multisampled | feature_point_lights | feature_mesh_shadows;
    case ShaderKind::textured_terrain:
        return any | feature_normal_map | feature_bump | feature_emboss | feature_multisampled |
               feature_sliver | feature_corner_depth | feature_point_lights | feature_mesh_shadows;
    case ShaderKind::relief_hull:
        return any | search | feature_hard_shadow | feature_soft_shadow | feature_wrap |
               feature_multisampled | feature_point_lights;
    case ShaderKind::relief_terrain:
        return any | search | feature_hard_shadow | feature_soft_shadow | feature_multisampled |
               feature_sliver | feature_corner_depth | feature_point_lights | feature_mesh_shadows;
    case ShaderKind::sky:
        return any | feature_sky_picture;
    default:
        return any;
    }
}

/// Every variant with an effect, each once.
inline std::vector<ShaderVariant> find_all_variants() {
    std::set<ShaderVariant> variants;
    std::unordered_set<std::uint64_t> known; // most of millions of subsets are one of few variants
    const auto add = [&](ShaderVariant variant) {
        const auto kind = static_cast<std::uint64_t>(variant.kind);
        if (known.insert(kind << 48U | variant.features).second) {
            variants.insert(variant);
        }
    };
    for (int index = 0; index <= static_cast<int>(ShaderKind::average); ++index) {
        const auto kind = static_cast<ShaderKind>(index);
        const ShaderFeatures all = possible_features(kind);
        ShaderFeatures features = all;
        add(canonical_variant({kind, features}));
        while (features != 0) {
            features = (features - 1) & all; // the next subset
            add(canonical_variant({kind, features}));
        }
    }
    // Instead of twice as many subsets.
    const std::set<ShaderVariant> without = variants;
    for (ShaderVariant variant : without) {
        if (variant.kind == ShaderKind::relief && (variant.features & feature_curved) != 0) {
            variant.features |= feature_degrees;
            add(canonical_variant(variant));
        }
    }
    return {variants.begin(), variants.end()};
}

/// The same, in order; found once for all tests of this process.
inline const std::vector<ShaderVariant>& all_variants() {
    static const std::vector<ShaderVariant> all = find_all_variants();
    return all;
}

} // namespace reljef::render
