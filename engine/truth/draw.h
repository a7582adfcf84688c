#pragma once

#include <functional>

#include <glm/vec2.hpp>

#include "engine/core/color.h"
#include "engine/core/hit.h"
#include "engine/core/parallel_for.h"
#include "engine/core/result.h"
#include "engine/scene/graph/scene.h"
#include "engine/truth/scene_caster.h"
#include "engine/truth/shading.h"

namespace reljef::truth {

struct DrawOptions {
    /// Rays along each side of a pixel, >= 1. The colour is their linear mean; the hit is that of
    /// the pixel's centre.
    int rays_per_side = 1;
    SunShadow shadow = SunShadow::sweep; ///< of the overload that makes the shading
    ParallelOptions parallel = {};       ///< no influence on the result; drawing fails when stopped
};

struct Picture {
    HitBuffer hits;
    Image image;
};

/// The exact picture of a scene's terrains by its active camera; `size` in pixels, each side >= 1.
/// Rays begin at the camera's near depth, orthographic rays in front of the scene. Light, shadow,
/// air and sky are those of the driver, evaluated at the hit. Fails as SceneCaster::create and when
/// stopped.
Result<Picture> draw(const scene::Scene& scene, glm::ivec2 size, const DrawOptions& options = {});

/// The same with prepared terrains and light.
Result<Picture> draw(const SceneCaster& caster, const Shading& shading, const scene::Camera& camera,
                     glm::ivec2 size, const DrawOptions& options = {});

/// Only the hits.
Result<HitBuffer> draw_hits(const scene::Scene& scene, glm::ivec2 size,
                            const ParallelOptions& parallel = {});
Result<HitBuffer> draw_hits(const SceneCaster& caster, const scene::Camera& camera, glm::ivec2 size,
                            const ParallelOptions& parallel = {});

/// Calls `body` for every pixel of a picture, from several threads. Fails when stopped.
Result<void> for_each_pixel(glm::ivec2 size, const ParallelOptions& parallel,
                            const std::function<void(glm::ivec2 pixel)>& body);

/// The mean of `color_at` over a grid of n × n places in a pixel.
glm::vec3 mean_color(glm::ivec2 pixel, int n,
                     const std::function<glm::vec3(glm::dvec2 place)>& color_at);

} // namespace reljef::truth
