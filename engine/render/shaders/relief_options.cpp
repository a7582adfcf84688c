#include "engine/render/shaders/relief_options.h"

#include <glm/vec4.hpp>

#include "engine/render/shaders/shader_library.h"

namespace reljef::render {
namespace {

// The parameters, in the catalogue's order; of equal steps zw: steps from straight above and along
// the ground.
glm::vec4 search_values(const scene::Technique& technique) {
    if (technique.id == scene::TechniqueId::pom) { // one chord
        return {0.0F, 1.0F, technique.values[0], technique.values[1]};
    }
    glm::vec4 values(0.0F);
    for (std::size_t i = 0; i < technique.values.size(); ++i) {
        values[static_cast<int>(i)] = static_cast<float>(technique.values[i]);
    }
    if (const auto& steps = technique.options.steps) {
        values.z = static_cast<float>(steps->low);
        values.w = static_cast<float>(steps->high);
    }
    return values;
}

std::uint32_t search_features(scene::TechniqueId id) {
    switch (id) {
    case scene::TechniqueId::parallax:
        return feature_parallax;
    case scene::TechniqueId::parallax_limited:
        return feature_parallax | feature_limited;
    case scene::TechniqueId::parallax_iterated:
        return feature_parallax | feature_iterated;
    case scene::TechniqueId::relief:
        return feature_bisect;
    case scene::TechniqueId::interval:
        return feature_secant;
    case scene::TechniqueId::pom:
        return feature_secant | feature_view_steps;
    case scene::TechniqueId::cone:
        return feature_cone;
    case scene::TechniqueId::exact:
        return feature_exact;
    case scene::TechniqueId::lattice:
    case scene::TechniqueId::dual_layer:
    case scene::TechniqueId::multi_layer:
        return feature_layers;
    default:
        return 0U;
    }
}

std::uint32_t option_features(const scene::TechniqueOptions& options) {
    std::uint32_t features = 0U;
    features |= options.steps ? feature_view_steps : 0U;
    features |= options.fade ? feature_fade : 0U;
    features |= options.smooth_edges ? feature_smooth_edges : 0U;
    features |= options.writes_depth ? feature_write_depth : 0U;
    if (options.shadow) {
        features |= options.shadow->depth > 0.0 ? feature_soft_shadow : feature_hard_shadow;
    }
    return features;
}

} // namespace

std::uint32_t relief_features(const scene::Technique& technique) {
    const std::uint32_t beams = has_beams(technique) ? feature_beams : 0U;
    return search_features(technique.id) | option_features(technique.options) | beams;
}

bool has_beams(const scene::Technique& technique) {
    const bool begins_anywhere = technique.id == scene::TechniqueId::exact ||
                                 technique.id == scene::TechniqueId::cone ||
                                 technique.id == scene::TechniqueId::interval;
    return begins_anywhere && !technique.options.steps && !technique.options.fade;
}

bool is_parallax(scene::TechniqueId id) {
    return id == scene::TechniqueId::parallax || id == scene::TechniqueId::parallax_limited ||
           id == scene::TechniqueId::parallax_iterated;
}

double reference_height(const scene::Technique& technique) {
    return is_parallax(technique.id) ? -technique.values.front() : 0.5;
}

TechniqueBlock technique_block(const scene::Technique& technique, double reference) {
    const scene::TechniqueOptions& options = technique.options;
    TechniqueBlock block{};
    block.search_values = search_values(technique);
    if (options.fade) {
        block.fade_values =
            glm::vec4(options.fade->low, options.fade->high, options.fade->power, reference);
    }
    if (options.shadow) {
        block.option_values.x = static_cast<float>(options.shadow->depth);
    }
    if (options.smooth_edges) {
        block.option_values.y = static_cast<float>(*options.smooth_edges);
    }
    return block;
}

} // namespace reljef::render
