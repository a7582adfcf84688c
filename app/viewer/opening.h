#pragma once

#include <memory>
#include <optional>
#include <stop_token>

#include "engine/core/result.h"
#include "engine/platform/window.h"
#include "engine/session/log.h"
#include "engine/session/prepared_maps.h"
#include "engine/session/scene_setup.h"

namespace reljef::app {

struct OpenedScene {
    session::TerrainScene scene;
    /// Of first_technique(); null in the gallery.
    std::shared_ptr<const render::PreparedLight> light;
};

/// Opens a scene in the background, so that the window answers meanwhile and shows the progress.
/// Nothing if the user closes the window. Fails as open_scene, and when it was stopped. The maps of
/// the scene's technique are left to the viewer. `largest_side`: SceneRenderer::max_texture_side().
Result<std::optional<OpenedScene>> open_in_window(platform::Window& window,
                                                  const session::SourceOptions& terrain,
                                                  const session::SceneOptions& view,
                                                  int largest_side, session::Log& log,
                                                  const std::stop_token& stop);

} // namespace reljef::app
