#pragma once

#include <span>

#include <glm/vec2.hpp>

#include "bench/baselines/baseline_scene.h"
#include "engine/core/hit.h"
#include "engine/core/result.h"
#include "engine/truth/geometric_error.h"

namespace reljef::bench {

/// Contains the visible depths with a margin of a factor of 2, metres.
struct DepthRange {
    double near = 1.0;
    double far = 2.0;
};
/// `far` is 0 if no pixel shows terrain.
DepthRange depth_range_of(const HitBuffer& hits);

/// What every program draws: the scene with its camera, and the size of the picture in pixels.
struct BaselineView {
    BaselineScene scene;
    glm::ivec2 size{0};
    DepthRange range = {}; ///< of the pose
    unsigned threads = 0;  ///< 0: all of the machine

    [[nodiscard]] truth::SurfaceView surface() const;
    void set_technique(const scene::Technique& technique);
    /// Samples of the terrain, along each side.
    [[nodiscard]] int side() const { return scene.surface().heightfield().heights.cols(); }
};

/// Hits from depths along the view axis, metres, by rows from the top; infinity: no terrain.
/// Precondition: a depth per pixel.
HitBuffer hits_from_depths(const BaselineView& view, std::span<const double> depths);

} // namespace reljef::bench
