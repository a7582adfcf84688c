#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "engine/core/result.h"
#include "engine/gl/framebuffer.h"
#include "engine/gl/program.h"
#include "engine/render/residency/residency.h"
#include "engine/scene/graph/camera.h"

namespace reljef::render {

/// The rays of a picture in a relief's search space: origin and direction of the ray through a
/// place (x, y) of the picture, in pixels from its lower left corner, are these times (1, x, y).
struct PictureRays {
    glm::mat3 origin_of_ray;
    glm::mat3 direction_of_ray;
    float begin_height; ///< where a ray meets the search space at the highest
};
PictureRays picture_rays(const scene::Camera& camera, glm::ivec2 size, const ReliefSpace& space,
                         const glm::dmat4& local_from_world);

/// Where beams keep down to which height they meet nothing: a float for each block of pixels of the
/// picture. Made when a list has beams. Needs a current context; destroy while it is current.
class BeamTarget {
public:
    /// Fails where the driver has no memory.
    Result<void> prepare(const view::DrawList& list);

    [[nodiscard]] const gl::Framebuffer& framebuffer() const { return framebuffer_; }

private:
    gl::Framebuffer framebuffer_;
    glm::ivec2 picture_size_{0}; // that it is for
};

/// The uniforms of beams.frag and the pyramid it looks in. Precondition: the relief has its
/// greatest heights.
void set_beams(gl::Program& program, const ResidentRelief& relief, const PictureRays& rays);

} // namespace reljef::render
