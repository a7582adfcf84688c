#pragma once

#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "engine/scene/graph/daylight.h"
#include "engine/scene/graph/scene.h"
#include "engine/session/log.h"
#include "engine/session/objects/placed_buildings.h"
#include "engine/session/objects/placed_lights.h"
#include "engine/session/objects/placed_objects.h"
#include "engine/session/options.h"
#include "engine/session/terrain_source.h"

namespace reljef::session {

/// What surrounds a terrain, besides the sun.
struct Surroundings {
    double turbidity = scene::default_turbidity;
    std::optional<double> visibility; ///< metres; 0: no haze; absent: by the terrain's size
    BaseKind base = BaseKind::plane;
    std::shared_ptr<const material::SkyPicture> sky; ///< null: the sky of the sun's altitude
    std::optional<geo::UniversalTime> sun_time;      ///< that gave the sun its first place
};

struct TerrainScene {
    scene::Scene scene;
    scene::Node* terrain = nullptr;   ///< owned by the scene
    scene::Node* camera = nullptr;    ///< owned by the scene
    scene::Node* light = nullptr;     ///< owned by the scene
    std::vector<scene::Node*> models; ///< the gallery's, owned by the scene
    std::vector<PlacedObject> objects;
    std::vector<StandingLight> point_lights;
    PlacedBuildings buildings;   ///< on footprints
    scene::Node* city = nullptr; ///< the buildings of `urban` as meshes, owned by the scene
    /// The same city as heights; null: the terrain has all that stands on it.
    std::shared_ptr<const scene::TerrainSurface> city_heights;
    Box bounds; ///< of the terrain, scene metres
    Surroundings surroundings;
    bool is_gallery = false;
    std::optional<double> usual_grain; ///< of several colours; absent: the user named one
    std::size_t failed_files = 0;      ///< left out when the terrain was opened
    RayUse rays = RayUse::none;
    bool mesh_levels = true; ///< SceneOptions::mesh_levels
    /// Of a streamed terrain, without its overview; else null.
    std::shared_ptr<const TerrainSource> source;

    /// z of the ground at x, y; the lowest point of the terrain where there is none.
    [[nodiscard]] double ground(double x, double y) const;

    /// The camera of a pose: of a city the same in each of its forms, bit for bit.
    [[nodiscard]] scene::Camera pose_camera(scene::Pose pose) const;
    /// What cameras show that show everything: the terrain, and the buildings of a city.
    [[nodiscard]] const Box& shown_bounds() const {
        return city_heights != nullptr ? city_heights->bounds() : bounds;
    }

    /// Of the models, or of the terrain if there are none.
    [[nodiscard]] std::vector<scene::Material*> materials() const;
    /// Fails as scene::check_technique of these materials.
    [[nodiscard]] Result<void> check(const scene::Technique& technique) const;
};

/// The near plane of cameras over a terrain, metres: cuts nothing away that can be seen.
double near_distance(const Box& bounds);

/// Builds the scene. Fails if the placement or the camera does not fit the terrain; wrong options
/// are usage errors.
Result<TerrainScene> make_scene(TerrainSource source, const SourceOptions& terrain,
                                const SceneOptions& view, Log& log,
                                const std::stop_token& stop = {});

/// Opens a terrain and sets up its scene: open_terrain, add_proofs, make_scene, geoid_note and,
/// with `view.prepares_maps`, prepare_maps.
Result<TerrainScene> open_scene(io::SceneDescription description, const SourceOptions& terrain,
                                const SceneOptions& view, Log& log, const std::stop_token& stop);

/// The same for the terrain that `terrain.terrain` names.
Result<TerrainScene> open_scene(const SourceOptions& terrain, const SceneOptions& view, Log& log,
                                const std::stop_token& stop = {});

/// The first part of open_scene, for which no renderer need be known: open_terrain and add_proofs.
Result<TerrainSource> open_source(io::SceneDescription description, const SourceOptions& terrain,
                                  const SceneOptions& view, Log& log, const std::stop_token& stop);
Result<TerrainSource> open_source(const SourceOptions& terrain, const SceneOptions& view, Log& log,
                                  const std::stop_token& stop);
/// The other part.
Result<TerrainScene> open_scene(TerrainSource source, const SourceOptions& terrain,
                                const SceneOptions& view, Log& log, const std::stop_token& stop);

} // namespace reljef::session
