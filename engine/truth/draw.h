#pragma once

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
    /// Rays along each side of a pixel; the colour is the linear mean of all, the hit always that
    /// of the pixel's centre. >= 1.
    int rays_per_side = 1;
    SunShadow shadow = SunShadow::sweep; ///< where the shading is made from the scene
    ParallelOptions parallel = {}; ///< stopped, drawing fails; the result depends on nothing of it
};

/// What every pixel shows.
struct Picture {
    HitBuffer hits;
    Image image;
};

/// The exact picture of a scene's terrains by its active camera, `size` in pixels, each side >= 1.
/// Each pixel shows what the ray through its centre meets, from the camera's near depth on:
/// orthographic rays begin before all of the scene. Light, shadow, air and sky are what the driver
/// draws, evaluated at the hit itself. Fails as SceneCaster::create, and when it is stopped.
Result<Picture> draw(const scene::Scene& scene, glm::ivec2 size, const DrawOptions& options = {});

/// The same of a scene whose terrains and light are ready: another camera costs only its rays.
Result<Picture> draw(const SceneCaster& caster, const Shading& shading, const scene::Camera& camera,
                     glm::ivec2 size, const DrawOptions& options = {});

/// The hits alone.
Result<HitBuffer> draw_hits(const scene::Scene& scene, glm::ivec2 size,
                            const ParallelOptions& parallel = {});
Result<HitBuffer> draw_hits(const SceneCaster& caster, const scene::Camera& camera, glm::ivec2 size,
                            const ParallelOptions& parallel = {});

} // namespace reljef::truth
