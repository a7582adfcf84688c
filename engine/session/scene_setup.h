#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "app/cli/options.h"
#include "engine/scene/graph/scene.h"
#include "engine/scene/motion/fly_path.h"
#include "engine/session/terrain_source.h"

namespace reljef::session {

/// A terrain under a sun and a sky, with a camera.
struct TerrainScene {
    scene::Scene scene;
    scene::Node* terrain = nullptr;   ///< owned by the scene
    scene::Node* camera = nullptr;    ///< owned by the scene
    scene::Node* light = nullptr;     ///< owned by the scene
    std::vector<scene::Node*> models; ///< the gallery's, owned by the scene
    Box bounds;                       ///< of the terrain, scene metres

    /// z of the ground at x, y; the lowest of the terrain where there is none.
    [[nodiscard]] double ground(double x, double y) const;

    /// What a technique is chosen for: the models where there are some, else the terrain.
    [[nodiscard]] std::vector<scene::Material*> materials() const;
    /// Whether they can be drawn so. Fails as scene::check_technique.
    [[nodiscard]] Result<void> check(const scene::Technique& technique) const;
};

/// Builds the scene. Fails where the placement or the camera does not fit the terrain, and refuses
/// (misuse.h) options that do not fit what is drawn.
Result<TerrainScene> make_scene(TerrainSource source, const cli::TerrainChoice& terrain,
                                const cli::ViewChoice& view, const std::stop_token& stop = {});

/// A note where heights are drawn from the ellipsoid on although they may count from another zero:
/// no geoid is applied, and the user did not ask for that.
std::optional<std::string> missing_geoid(const TerrainScene& scene,
                                         const cli::TerrainChoice& terrain);

/// Reads what the technique's error needs of the terrain from the cache, or makes and keeps it,
/// with progress and a note on stderr: its bisection. Nothing to do for other techniques and for
/// streams of tiles. Fails when it was stopped.
Result<void> prepare_bisection(TerrainScene& scene, const cli::TerrainChoice& terrain,
                               const std::stop_token& stop);

/// The path that --path names, with notes on stderr; nothing without one.
Result<std::optional<scene::FlyPath>> open_path(const TerrainScene& scene,
                                                const cli::ViewChoice& view,
                                                const cli::TerrainChoice& terrain);

/// Puts the camera where frame `index` of so many evenly spread along a path sees from, be it under
/// the ground: see fly_above_ground in frame_maker.h.
void fly_to(TerrainScene& scene, const scene::FlyPath& path, int index, int frames);

} // namespace reljef::session
