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

/// The rays of a picture in a relief's search space: matrix · (1, x, y) is the origin or direction
/// of the ray through (x, y), in pixels from the lower left corner.
struct PictureRays {
    glm::mat3 origin_of_ray;
    glm::mat3 direction_of_ray;
    float begin_height; ///< highest entry of a ray into the search space
};
PictureRays picture_rays(const scene::Camera& camera, glm::ivec2 size, const ReliefSpace& space,
                         const glm::dmat4& local_from_world);

/// Whether rays of a relief in the list begin where their beam may hit.
bool needs_beams(const view::DrawList& list);

/// The heights down to which beams meet nothing: a float per block of pixels. Created for the first
/// list with beams. `counts`: also the taps of each beam.
class BeamTarget {
public:
    explicit BeamTarget(bool counts = false) : counts_(counts) {}

    Result<void> prepare(const view::DrawList& list);

    [[nodiscard]] const gl::Framebuffer& framebuffer() const { return framebuffer_; }

private:
    gl::Framebuffer framebuffer_;
    glm::ivec2 picture_size_{0};
    bool counts_;
};

/// Sets the rays of beams.frag.
void set_beams(gl::Program& program, const ReliefSpace& space, const PictureRays& rays);

} // namespace reljef::render
