#include "engine/render/passes/sample_target.h"

#include <array>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "engine/core/check.h"
#include "engine/render/shaders/bindings.h"
#include "engine/render/shaders/uniforms.h"

namespace reljef::render {
namespace {

constexpr int max_passes = 4;

// Sample positions of Direct3D 11 and most GPUs, in 1/16 pixel from the centre, right and down. All
// rows and columns differ, which is best for steep and flat edges.
constexpr std::array one_place{glm::ivec2(0, 0)};
constexpr std::array two_places{glm::ivec2(4, 4), glm::ivec2(-4, -4)};
constexpr std::array four_places{glm::ivec2(-2, -6), glm::ivec2(6, -2), glm::ivec2(-6, 2),
                                 glm::ivec2(2, 6)};

std::span<const glm::ivec2> places_of(int passes) {
    if (passes == 1) {
        return one_place;
    }
    return passes == 2 ? std::span<const glm::ivec2>(two_places) : four_places;
}

} // namespace

Result<SamplePlan> plan_samples(int samples, std::span<const int> counts) {
    SamplePlan plan{1, samples};
    for (const int count : counts) {
        if (count > plan.at_once && samples % count == 0) {
            plan = {count, samples / count};
        }
    }
    if (plan.passes > max_passes) {
        return Error{fmt::format("picture with {} samples a pixel: expected at most {} with this "
                                 "renderer",
                                 samples, max_passes * plan.at_once)};
    }
    return plan;
}

glm::dvec2 pass_shift(const SamplePlan& plan, int pass) {
    const std::span<const glm::ivec2> places = places_of(plan.passes);
    check(pass >= 0 && static_cast<std::size_t>(pass) < places.size(), "no such pass");
    // The hardware samples also have different rows and columns.
    return glm::dvec2(places[static_cast<std::size_t>(pass)]) / (16.0 * plan.at_once);
}

Result<SampleTarget> SampleTarget::create(glm::ivec2 size, int samples) {
    const auto plan = plan_samples(samples, gl::sample_counts({}));
    if (!plan) {
        return plan.error();
    }
    SampleTarget made;
    made.plan_ = *plan;
    auto picture = gl::Framebuffer::create({.size = size, .samples = plan->at_once});
    if (!picture) {
        return Error{fmt::format("picture of {} x {} pixels with {} samples each: too large for "
                                 "this renderer, fewer samples or pixels were expected",
                                 size.x, size.y, samples)};
    }
    made.picture_ = std::move(*picture);
    for (int i = 0; plan->passes > 1 && i < plan->passes; ++i) {
        auto pass = gl::Framebuffer::create({.size = size, .depth = false});
        if (!pass) {
            return pass.error();
        }
        made.passes_.push_back(std::move(*pass));
    }
    return made;
}

bool SampleTarget::is_for(glm::ivec2 size, int samples) const {
    return picture_.size() == size && plan_.at_once * plan_.passes == samples;
}

Result<void> SampleTarget::add_pass(int pass, const gl::Framebuffer& target, DrawState& state,
                                    const gl::VertexArray& no_vertices) {
    const bool is_only = plan_.passes == 1;
    picture_.resolve_to(is_only ? target : passes_[static_cast<std::size_t>(pass)]);
    const bool is_last = pass + 1 == plan_.passes;
    return is_last && !is_only ? draw_mean(target, state, no_vertices) : Result<void>();
}

Result<void> SampleTarget::draw_mean(const gl::Framebuffer& target, DrawState& state,
                                     const gl::VertexArray& no_vertices) const {
    auto program = state.use({ShaderKind::average});
    if (!program) {
        return program.error();
    }
    for (std::size_t unit = 0; unit < passes_.size(); ++unit) {
        passes_[unit].color().bind(bindings::picture_0_unit + static_cast<unsigned>(unit));
    }
    (*program)->set(uniforms.picture_count, plan_.passes);
    target.bind();
    no_vertices.bind();
    gl::set_depth_test(gl::DepthTest::off);
    gl::draw_arrays(gl::Primitive::triangles, 3);
    gl::set_reversed_depth();
    state.stats().state_changes += 5;
    ++state.stats().draws;
    return {};
}

} // namespace reljef::render
