#pragma once

#include <optional>

#include <glm/vec2.hpp>

#include "app/viewer/panels/panel_content.h"
#include "app/viewer/render_command_text.h"
#include "app/viewer/viewer.h"
#include "engine/session/ground.h"
#include "engine/session/picture/scene_marks.h"
#include "engine/session/scene_setup.h"

namespace reljef::app {

/// What the panels show of the scene and the viewer; without the frame, messages, samples and the
/// cursor, which the window has. Leaves the legend empty.
PanelContent content_of(const Viewer& viewer, const session::TerrainScene& scene,
                        glm::ivec2 window);

/// For the command that renders what a window of `size` pixels shows. `samples`: as in
/// WindowLoopOptions. A ramp of a file keeps the name that it had at the start.
ShownState shown_state(const Viewer& viewer, const session::TerrainScene& scene, glm::ivec2 size,
                       std::optional<int> samples);

/// A point of the scene.
PlaceContent place_of(const session::TerrainScene& scene, const session::PickedPlace& picked);

using session::legend_of;

} // namespace reljef::app
