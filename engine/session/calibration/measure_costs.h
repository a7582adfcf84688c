#pragma once

#include <stop_token>

#include "engine/core/parallel_for.h"
#include "engine/core/result.h"
#include "engine/session/scene_renderer.h"
#include "engine/session/scene_setup.h"

namespace reljef::session {

/// A frame of a moving view, and what it drew.
struct FrameCost {
    double ms = 0.0;
    double triangles = 0.0;
    double touched_pixels = 0.0; ///< by edges of triangles, as `auto` estimates them
    double pixels = 0.0; ///< that show terrain; of rays, those that search, as `auto` counts them
    double steps = 0.0;  ///< of searches
};

/// Measurements from which costs follow. Times are medians, counts are means.
struct MeasuredFrames {
    FrameCost sky;          ///< nothing but the sky
    FrameCost few;          ///< few triangles
    FrameCost many;         ///< many triangles of the same views
    FrameCost flat;         ///< many triangles that are seen at a flat angle
    FrameCost rays;         ///< rays, of the same views
    FrameCost fewer_pixels; ///< rays of views with fewer pixels of terrain
    FrameCost few_steps;    ///< searches with few steps, of the views of `rays`
    FrameCost many_steps;   ///< searches with many, of the same views
    FrameCost sampled_sky;  ///< as `sky`, `few` and `many`, with four samples a pixel
    FrameCost sampled_few;
    FrameCost sampled_many;
};
/// None is negative.
Costs costs_from(const MeasuredFrames& frames);

/// Draws a scene of a terrain over a plane from moving views, and leaves the renderer with other
/// samples. Fails as the renderer, or when stopped.
Result<MeasuredFrames> measure_frames(TerrainScene& scene, SceneRenderer& renderer,
                                      const std::stop_token& stop, const Progress& progress);

} // namespace reljef::session
