#pragma once

#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/core/result.h"
#include "engine/gl/framebuffer.h"
#include "engine/gl/vertex_array.h"
#include "engine/render/passes/draw_state.h"

namespace reljef::render {

/// How the samples of a pixel are drawn: so many at once by the renderer, in so many passes, each
/// of which draws the picture shifted by a part of a pixel.
struct SamplePlan {
    int at_once = 1;
    int passes = 1; ///< 1, 2 or 4

    friend bool operator==(const SamplePlan&, const SamplePlan&) = default;
};

/// As few passes as possible. `counts`: the samples that the renderer can draw at once, rising, 1
/// among them. Fails where that takes more than 4 passes: OpenGL 4.5 promises 4 samples at once.
Result<SamplePlan> plan_samples(int samples, std::span<const int> counts);

/// Where a pass samples pixels, from their centres: pixels right and down (scene::Camera::shift).
/// Places lie on the grid of 1/256 pixel that rasterizers put vertices on.
glm::dvec2 pass_shift(const SamplePlan& plan, int pass);

/// Where a picture with several samples a pixel is drawn, pass by pass. Needs a current context;
/// destroy while it is current.
class SampleTarget {
public:
    SampleTarget() = default;

    /// `samples`: 2, 4, 8 or 16. Fails as plan_samples(), and where the driver has no memory.
    static Result<SampleTarget> create(glm::ivec2 size, int samples);

    [[nodiscard]] bool is_for(glm::ivec2 size, int samples) const;
    [[nodiscard]] const SamplePlan& plan() const { return plan_; }
    /// What each pass is drawn to.
    [[nodiscard]] const gl::Framebuffer& picture() const { return picture_; }

    /// After each pass, in turn; after the last, the mean of all samples, in linear light, becomes
    /// the target's colour. Fails as ShaderLibrary::program.
    Result<void> add_pass(int pass, const gl::Framebuffer& target, DrawState& state,
                          const gl::VertexArray& no_vertices);

private:
    Result<void> draw_mean(const gl::Framebuffer& target, DrawState& state,
                           const gl::VertexArray& no_vertices) const;

    SamplePlan plan_;
    gl::Framebuffer picture_;
    std::vector<gl::Framebuffer> passes_; // where there are several
};

} // namespace reljef::render
