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
    /// For first_technique(); null in the gallery.
    std::shared_ptr<const view::PreparedLight> light;
};

/// Opens a scene in the background while the window shows the progress. Empty if the user closes
/// the window. Fails as open_scene() or when stopped. Does not make the maps of the technique.
/// `largest_side`: SceneRenderer::max_texture_side().
Result<std::optional<OpenedScene>> open_in_window(platform::Window& window,
                                                  const session::SourceOptions& terrain,
                                                  const session::SceneOptions& view,
                                                  int largest_side, session::Log& log,
                                                  const std::stop_token& stop);

} // namespace reljef::app
