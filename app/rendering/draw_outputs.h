#pragma once

#include "app/cli/interrupt.h"
#include "app/rendering/render_choice.h"
#include "engine/core/result.h"
#include "engine/session/frame_maker.h"
#include "engine/session/log.h"
#include "engine/session/scene_setup.h"

namespace reljef::app {

/// One run of `reljef render`. All members outlive it.
struct Rendering {
    const RenderChoice& choice;
    session::TerrainScene& scene;
    session::FrameMaker& maker;
    session::Log& log;
    const cli::Interrupt& interrupt;
};

/// Draws all frames and hits, and puts all files in their places at the end: none if anything
/// fails or is interrupted, but for numbered pictures that are complete. Logs the kept error and
/// cameras that were lifted above the ground; `has_camera_of_file`: the terrain's file gave it.
Result<void> draw_outputs(const Rendering& run, bool has_camera_of_file);

} // namespace reljef::app
