#pragma once

#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/core/result.h"
#include "engine/gl/framebuffer.h"
#include "engine/gl/vertex_array.h"
#include "engine/render/passes/draw_state.h"

namespace reljef::render {

/// How to draw the samples of a pixel: hardware samples times passes. Each pass draws the picture
/// shifted by a part of a pixel.
struct SamplePlan {
    int at_once = 1; ///< hardware samples
    int passes = 1;  ///< 1, 2 or 4

    friend bool operator==(const SamplePlan&, const SamplePlan&) = default;
};

/// The fewest passes. `counts`: see gl::sample_counts(). Fails above 4 passes; OpenGL 4.5
/// guarantees 4 hardware samples.
Result<SamplePlan> plan_samples(int samples, std::span<const int> counts);

/// A pass's sample position from the pixel's centre, in pixels right and down
/// (scene::Camera::shift). It lies on the rasterizers' vertex grid of 1/256 pixel.
glm::dvec2 pass_shift(const SamplePlan& plan, int pass);

/// The target of a picture with several samples per pixel.
class SampleTarget {
public:
    SampleTarget() = default;

    /// `samples`: 2, 4, 8 or 16. Fails as plan_samples() and without GL memory.
    static Result<SampleTarget> create(glm::ivec2 size, int samples);

    [[nodiscard]] bool is_for(glm::ivec2 size, int samples) const;
    [[nodiscard]] const SamplePlan& plan() const { return plan_; }
    [[nodiscard]] const gl::Framebuffer& picture() const { return picture_; }

    /// Call after each pass, in order. The last call writes the mean of all samples, in linear
    /// light, to `target`. Fails as ShaderLibrary::program.
    Result<void> add_pass(int pass, const gl::Framebuffer& target, DrawState& state,
                          const gl::VertexArray& no_vertices);

private:
    Result<void> draw_mean(const gl::Framebuffer& target, DrawState& state,
                           const gl::VertexArray& no_vertices) const;

    SamplePlan plan_;
    gl::Framebuffer picture_;
    std::vector<gl::Framebuffer> passes_;
};

} // namespace reljef::render
