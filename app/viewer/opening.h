#pragma once

#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "app/viewer/appearance/background.h"
#include "app/viewer/panels/panels.h"
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
    /// All samples, if the scene begins with fewer; else null.
    std::shared_ptr<const terrain::Terrain> finer = {};
};

/// With what a scene begins.
enum class FirstSamples {
    /// Fewer than a file has, if it has more than 500,000, is not streamed, does not close around
    /// the Earth, and is seen whole: without a named technique, a camera, objects or footprints.
    few,
    all
};

/// Reads a terrain in the background, from the construction on: its window is made meanwhile. The
/// destructor stops and waits.
class Opening {
public:
    Opening(const session::SourceOptions& terrain, const session::SceneOptions& view,
            FirstSamples first = FirstSamples::few);

    /// Opens the scene in the background, without the maps of the technique. `largest_side`:
    /// SceneRenderer::max_texture_side(). Call it once.
    void begin(session::RayUse rays, int largest_side);
    /// Waits while the window shows the progress. Empty if the user closes the window, which
    /// requests the stop, or when stopped. Fails as session::open_scene. Precondition: begun. Call
    /// it once.
    Result<std::optional<OpenedScene>> finish(platform::Window& window, session::Log& log,
                                              std::stop_source stop);

private:
    Result<OpenedScene> open(const session::SceneOptions& view, int largest_side,
                             const std::stop_token& stop);

    session::SourceOptions terrain_;
    session::SceneOptions view_;
    FirstSamples first_;
    session::RelayedLog relayed_;
    Background<session::TerrainSource> reading_;     // uses what is above
    std::optional<Background<OpenedScene>> opening_; // last: uses all others
};

/// Shows in an open window why there is no scene, until the user closes it (Esc) or `stop`. Returns
/// at once if the window has no room for panels. Precondition: its context is current.
void show_failure(platform::Window& window, Panels& panels, const std::string& sentence,
                  const std::stop_token& stop);

} // namespace reljef::app
