#include "engine/render/shaders/relief_options.h"

#include "engine/render/shaders/shader_library.h"

namespace reljef::render {
namespace {

// How the shaders of a technique search or light: their features, and the values that these read.
struct Search {
    std::uint32_t features = 0U;
    TechniqueBlock values{};
};

template <class Number> float block_value(Number number) {
    return static_cast<float>(number);
}

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
    Search search{.features = feature_emboss};
    search.values.emboss_delta = block_value(emboss.delta);
    return search;
}

Search search_of(const scene::Normal& /*normal*/) {
    return {.features = feature_normal_map};
}

Search search_of(const scene::Prewarp& /*prewarp*/) {
    return {.features = feature_normal_map | feature_warped};
}

Search search_of(const scene::Parallax& parallax) {
    Search search{.features = feature_parallax};
    search.values.parallax_offset = block_value(parallax.offset);
    return search;
}

Search search_of(const scene::ParallaxLimited& parallax) {
    Search search{.features = feature_parallax | feature_limited};
    search.values.parallax_offset = block_value(parallax.offset);
    return search;
}

Search search_of(const scene::ParallaxIterated& parallax) {
    Search search{.features = feature_parallax | feature_iterated};
    search.values.parallax_offset = block_value(parallax.offset);
    search.values.parallax_iterations = block_value(parallax.iterations);
    return search;
}

Search search_of(const scene::Steep& steep) {
    Search search;
    search.values.linear_steps = block_value(steep.linear_steps);
    return search;
}

Search search_of(const scene::Relief& relief) {
    Search search{.features = feature_bisect};
    search.values.linear_steps = block_value(relief.linear_steps);
    search.values.bisection_steps = block_value(relief.bisection_steps);
    return search;
}

Search search_of(const scene::Interval& interval) {
    Search search{.features = feature_secant};
    search.values.linear_steps = block_value(interval.linear_steps);
    search.values.secant_steps = block_value(interval.secant_steps);
    return search;
}

Search search_of(const scene::Pom& pom) {
    Search search{.features = feature_secant | feature_view_steps};
    search.values.secant_steps = 1.0F;
    search.values.steps_from_above = block_value(pom.min_steps);
    search.values.steps_along_ground = block_value(pom.max_steps);
    return search;
}

Search search_of(const scene::Cone& cone) {
    Search search{.features = feature_cone};
    search.values.cone_relaxed = block_value(cone.relaxed);
    search.values.cone_max_steps = block_value(cone.max_steps);
    search.values.cone_min_step = block_value(cone.min_step);
    search.values.bisection_steps = block_value(cone.bisection_steps);
    return search;
}

Search search_of(const scene::Exact& /*exact*/) {
    return {.features = feature_exact};
}

Search search_between_layers(int linear_steps, int bisection_steps) {
    Search search{.features = feature_layers};
    search.values.linear_steps = block_value(linear_steps);
    search.values.bisection_steps = block_value(bisection_steps);
    return search;
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
        search.values.steps_from_above = block_value(steps->low);
        search.values.steps_along_ground = block_value(steps->high);
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
    TechniqueBlock block = search_of(technique).values;
    if (options.fade) {
        block.fade_low = block_value(options.fade->low);
        block.fade_high = block_value(options.fade->high);
        block.fade_power = block_value(options.fade->power);
        block.fade_reference_height = block_value(reference);
    }
    if (options.shadow) {
        block.shadow_depth = block_value(options.shadow->depth);
    }
    if (options.smooth_edges) {
        block.edge_distance = block_value(options.smooth_edges->distance);
    }
    return block;
}

} // namespace reljef::render
