#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "engine/scene/graph/scene.h"
#include "engine/scene/motion/camera_path.h"
#include "engine/session/log.h"
#include "engine/session/options.h"
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
    bool is_gallery = false;
    std::size_t failed_files = 0; ///< that were left out when the terrain was opened

    /// z of the ground at x, y; the lowest of the terrain where there is none.
    [[nodiscard]] double ground(double x, double y) const;

    /// What a technique is chosen for: the models where there are some, else the terrain.
    [[nodiscard]] std::vector<scene::Material*> materials() const;
    /// Whether they can be drawn so. Fails as scene::check_technique.
    [[nodiscard]] Result<void> check(const scene::Technique& technique) const;
};

/// Builds the scene. Fails where the placement or the camera does not fit the terrain; options that
/// do not fit what is drawn are usage errors.
Result<TerrainScene> make_scene(TerrainSource source, const SourceOptions& terrain,
                                const SceneOptions& view, Log& log,
                                const std::stop_token& stop = {});

/// A note where heights are drawn from the ellipsoid on although they may count from another zero:
/// no geoid is applied, and the user did not ask for that.
std::optional<std::string> missing_geoid(const TerrainScene& scene, const SourceOptions& terrain);

/// Opens a terrain and sets up its scene: open_terrain, make_scene, missing_geoid and, where
/// `view.prepares_maps`, prepare_maps.
Result<TerrainScene> open_scene(io::SceneDescription description, const SourceOptions& terrain,
                                const SceneOptions& view, Log& log, const std::stop_token& stop);

/// The same for the terrain that `terrain.terrain` names.
Result<TerrainScene> open_scene(const SourceOptions& terrain, const SceneOptions& view, Log& log,
                                const std::stop_token& stop = {});

/// The camera path that `name` names: "orbit", "flyover" or a path file, whose notes are logged.
Result<scene::CameraPath> open_path(const TerrainScene& scene, const std::string& name, Log& log);

/// Whether `name` is a path file: neither a built-in path nor a measured track (GPX, KML, GeoJSON).
bool is_path_file(const std::string& name);

/// Puts the camera where frame `index` of so many evenly spread along a path sees from, be it under
/// the ground: see fly_above_ground in frame_maker.h.
void fly_to(TerrainScene& scene, const scene::CameraPath& path, int index, int frames);

} // namespace reljef::session
