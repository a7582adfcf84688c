#include "engine/render/shaders/relief_options.h"

#include "engine/render/shaders/shader_library.h"

namespace reljef::render {
namespace {

struct Search {
    ShaderFeatures features = 0U;
    TechniqueBlock values{};
};

template <class Number> float block_value(Number number) {
    return static_cast<float>(number);
}

Search parallax_search(ShaderFeatures features, double offset) {
    Search search{.features = feature_parallax | features};
    search.values.parallax_offset = block_value(offset);
    return search;
}

template <class Technique>
Search stepped_search(ShaderFeatures features, const Technique& technique) {
    Search search{.features = features};
    search.values.linear_steps = block_value(technique.linear_steps);
    return search;
}

template <class Technique>
Search bisection_search(ShaderFeatures features, const Technique& technique) {
    Search search = stepped_search(features, technique);
    search.values.bisection_steps = block_value(technique.bisection_steps);
    return search;
}

// Does not compile for a technique without an overload.
struct SearchVisitor {
    Search operator()(const scene::Texture& /*texture*/) const { return {}; }
    Search operator()(const scene::Polygons& /*polygons*/) const { return {}; }
    Search operator()(const scene::Automatic& /*automatic*/) const { return {}; }
    Search operator()(const scene::Displacement& /*displacement*/) const {
        return {.features = feature_normal_map};
    }
    Search operator()(const scene::Bump& /*bump*/) const { return {.features = feature_bump}; }
    Search operator()(const scene::Emboss& emboss) const {
        Search search{.features = feature_emboss};
        search.values.emboss_delta = block_value(emboss.delta);
        return search;
    }
    Search operator()(const scene::Normal& /*normal*/) const {
        return {.features = feature_normal_map};
    }
    Search operator()(const scene::Prewarp& /*prewarp*/) const {
        return {.features = feature_normal_map | feature_warped};
    }
    Search operator()(const scene::Parallax& parallax) const {
        return parallax_search(0U, parallax.offset);
    }
    Search operator()(const scene::ParallaxLimited& parallax) const {
        return parallax_search(feature_limited, parallax.offset);
    }
    Search operator()(const scene::ParallaxIterated& parallax) const {
        Search search = parallax_search(feature_iterated, parallax.offset);
        search.values.parallax_iterations = block_value(parallax.iterations);
        return search;
    }
    Search operator()(const scene::Steep& steep) const { return stepped_search(0U, steep); }
    Search operator()(const scene::Relief& relief) const {
        return bisection_search(feature_bisect, relief);
    }
    Search operator()(const scene::Interval& interval) const {
        Search search = stepped_search(feature_secant, interval);
        search.values.secant_steps = block_value(interval.secant_steps);
        return search;
    }
    Search operator()(const scene::Pom& pom) const {
        Search search{.features = feature_secant | feature_view_steps};
        search.values.secant_steps = 1.0F;
        search.values.steps_from_above = block_value(pom.min_steps);
        search.values.steps_along_ground = block_value(pom.max_steps);
        return search;
    }
    Search operator()(const scene::Cone& cone) const {
        Search search{.features = feature_cone};
        search.values.cone_relaxed = block_value(cone.relaxed);
        search.values.cone_max_steps = block_value(cone.max_steps);
        search.values.cone_min_step = block_value(cone.min_step);
        search.values.bisection_steps = block_value(cone.bisection_steps);
        return search;
    }
    Search operator()(const scene::Exact& /*exact*/) const { return {.features = feature_exact}; }
    Search operator()(const scene::Lattice& lattice) const {
        return bisection_search(feature_layers, lattice);
    }
    Search operator()(const scene::DualLayer& layers) const {
        return bisection_search(feature_layers, layers);
    }
    Search operator()(const scene::MultiLayer& layers) const {
        return bisection_search(feature_layers, layers);
    }
};

Search search_of(const scene::Technique& technique) {
    Search search = std::visit(SearchVisitor(), technique.parameters);
    if (const auto& steps = technique.options.steps) {
        search.values.steps_from_above = block_value(steps->low);
        search.values.steps_along_ground = block_value(steps->high);
    }
    return search;
}

ShaderFeatures option_features(const scene::TechniqueOptions& options) {
    ShaderFeatures features = 0U;
    features |= options.steps ? feature_view_steps : 0U;
    features |= options.fade ? feature_fade : 0U;
    features |= options.smooth_edges ? feature_smooth_edges : 0U;
    features |= options.depth == scene::HitDepth::write ? feature_write_depth : 0U;
    if (options.shadow) {
        features |= options.shadow->depth > 0.0 ? feature_soft_shadow : feature_hard_shadow;
    }
    return features;
}

} // namespace

ShaderFeatures technique_features(const scene::Technique& technique) {
    const ShaderFeatures beams = has_beams(technique) ? feature_beams : 0U;
    return search_of(technique).features | option_features(technique.options) | beams;
}

bool has_beams(const scene::Technique& technique) {
    const bool begins_anywhere = technique.id() == scene::TechniqueId::exact ||
                                 technique.id() == scene::TechniqueId::cone ||
                                 technique.id() == scene::TechniqueId::interval;
    return begins_anywhere && !technique.options.steps && !technique.options.fade;
}

bool uses_max_mipmap(const scene::Technique& technique) {
    return technique.id() == scene::TechniqueId::exact ||
           technique.id() == scene::TechniqueId::cone || has_beams(technique);
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
