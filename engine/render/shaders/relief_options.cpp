#include "engine/render/shaders/relief_options.h"

#include <glm/vec4.hpp>

#include "engine/render/shaders/shader_library.h"

namespace reljef::render {
namespace {

// How the shaders of a technique search or light: their features, and the values of search_values
// that these read. Of equal steps zw are the steps from straight above and along the ground.
struct Search {
    std::uint32_t features = 0U;
    glm::vec4 values{0.0F};
};

Search search_of(const scene::Texture& /*texture*/) {
    return {};
}

Search search_of(const scene::Polygons& /*polygons*/) {
    return {};
}

Search search_of(const scene::Displacement& /*displacement*/) {
    return {.features = feature_normal_map};
}

Search search_of(const scene::Bump& /*bump*/) {
    return {.features = feature_bump};
}

Search search_of(const scene::Emboss& emboss) {
    return {feature_emboss, {emboss.delta, 0.0, 0.0, 0.0}};
}

Search search_of(const scene::Normal& /*normal*/) {
    return {.features = feature_normal_map};
}

Search search_of(const scene::Prewarp& /*prewarp*/) {
    return {.features = feature_normal_map | feature_warped};
}

Search search_of(const scene::Parallax& parallax) {
    return {feature_parallax, {parallax.offset, 0.0, 0.0, 0.0}};
}

Search search_of(const scene::ParallaxLimited& parallax) {
    return {feature_parallax | feature_limited, {parallax.offset, 0.0, 0.0, 0.0}};
}

Search search_of(const scene::ParallaxIterated& parallax) {
    return {feature_parallax | feature_iterated, {parallax.offset, parallax.iterations, 0.0, 0.0}};
}

Search search_of(const scene::Steep& steep) {
    return {0U, {steep.linear_steps, 0.0, 0.0, 0.0}};
}

Search search_of(const scene::Relief& relief) {
    return {feature_bisect, {relief.linear_steps, relief.bisection_steps, 0.0, 0.0}};
}

Search search_of(const scene::Interval& interval) {
    return {feature_secant, {interval.linear_steps, interval.secant_steps, 0.0, 0.0}};
}

Search search_of(const scene::Pom& pom) {
    constexpr double chords = 1.0;
    return {feature_secant | feature_view_steps, {0.0, chords, pom.min_steps, pom.max_steps}};
}

Search search_of(const scene::Cone& cone) {
    return {feature_cone, {cone.relaxed, cone.max_steps, cone.bisection_steps, cone.min_step}};
}

Search search_of(const scene::Exact& /*exact*/) {
    return {.features = feature_exact};
}

Search search_between_layers(int linear_steps, int bisection_steps) {
    return {feature_layers, {linear_steps, bisection_steps, 0.0, 0.0}};
}

Search search_of(const scene::Lattice& lattice) {
    return search_between_layers(lattice.linear_steps, lattice.bisection_steps);
}

Search search_of(const scene::DualLayer& layers) {
    return search_between_layers(layers.linear_steps, layers.bisection_steps);
}

Search search_of(const scene::MultiLayer& layers) {
    return search_between_layers(layers.linear_steps, layers.bisection_steps);
}

// A technique that is new does not compile until it has a search_of.
Search search_of(const scene::Technique& technique) {
    Search search = std::visit([](const auto& parameters) { return search_of(parameters); },
                               technique.parameters);
    if (const auto& steps = technique.options.steps) {
        search.values.z = static_cast<float>(steps->low);
        search.values.w = static_cast<float>(steps->high);
    }
    return search;
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

std::uint32_t technique_features(const scene::Technique& technique) {
    const std::uint32_t beams = has_beams(technique) ? feature_beams : 0U;
    return search_of(technique).features | option_features(technique.options) | beams;
}

bool has_beams(const scene::Technique& technique) {
    const bool begins_anywhere = technique.id() == scene::TechniqueId::exact ||
                                 technique.id() == scene::TechniqueId::cone ||
                                 technique.id() == scene::TechniqueId::interval;
    return begins_anywhere && !technique.options.steps && !technique.options.fade;
}

double reference_height(const scene::Technique& technique) {
    const double* const offset = scene::parallax_offset(technique.parameters);
    return offset == nullptr ? 0.5 : -*offset;
}

TechniqueBlock technique_block(const scene::Technique& technique, double reference) {
    const scene::TechniqueOptions& options = technique.options;
    TechniqueBlock block{};
    block.search_values = search_of(technique).values;
    if (options.fade) {
        block.fade_values =
            glm::vec4(options.fade->low, options.fade->high, options.fade->power, reference);
    }
    if (options.shadow) {
        block.option_values.x = static_cast<float>(options.shadow->depth);
    }
    if (options.smooth_edges) {
        block.option_values.y = static_cast<float>(options.smooth_edges->distance);
    }
    return block;
}

} // namespace reljef::render
