#pragma once

#include <memory>
#include <optional>
#include <stop_token>

#include "app/viewer/comparing/compared_frames.h"
#include "app/viewer/message_history.h"
#include "app/viewer/panels/panels.h"
#include "app/viewer/paths/path_video.h"
#include "app/viewer/render_command_text.h"
#include "app/viewer/timing/frame_timer.h"
#include "app/viewer/viewer.h"
#include "engine/core/result.h"
#include "engine/platform/window.h"
#include "engine/session/scene_renderer.h"
#include "engine/terrain/field/heightfield.h"

namespace reljef::app {

struct WindowLoopOptions {
    int frames = 0; ///< draws this number of frames, then closes; 0: no limit
    /// Samples per pixel of all frames; absent: MotionQuality chooses.
    std::optional<int> samples = {};
    OpenVideo open_video = {}; ///< for the path as a video; empty: there are none
    StartOptions start = {};   ///< for the command that renders a view
    /// For a second technique beside the first; empty: there is none.
    ComparedFrames::MakeRenderer make_renderer = {};
    /// Null: none. Outlives the loop.
    Panels* panels = nullptr;
    /// Takes the loop's times; null: nothing does. Outlives the loop.
    FrameTimer* timer = nullptr;
    /// Of the ground that is shown, for the frames after the first; null: it is as fine as it gets.
    std::shared_ptr<const terrain::Terrain> finer = {};
};

/// Passes events to the viewer and draws its scene until the user or `stop` ends it. Fails if a
/// frame cannot be drawn.
Result<void> run_window_loop(platform::Window& window, session::SceneRenderer& renderer,
                             session::TerrainScene& scene, Viewer& viewer, MessageHistory& log,
                             const std::stop_token& stop, const WindowLoopOptions& options = {});

} // namespace reljef::app
