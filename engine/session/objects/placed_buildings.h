#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/building/building_faces.h"
#include "engine/building/footprint.h"
#include "engine/building/roof.h"
#include "engine/core/result.h"
#include "engine/io/formats/scene_file.h"
#include "engine/scene/graph/scene.h"

namespace reljef::session {

/// A building on a terrain, whatever the terrain's exaggeration.
struct Standing {
    building::Footprint samples; ///< corners as column and row
    double ground = 0.0;         ///< the lowest one at the outline, true metres
    double height = 0.0;         ///< of the highest point above it, metres
    building::RoofKind roof = building::RoofKind::flat;
};

/// The buildings of a scene; their node, which the scene owns, holds their meshes.
struct PlacedBuildings {
    scene::Node* node = nullptr; ///< null: there are none
    std::shared_ptr<const std::vector<Standing>> buildings;
    std::vector<std::string> notes; ///< one for each file that left something out
    bool has_levels = false;        ///< of detail
};

/// Heights at (latitude, longitude), true metres; empty in voids and outside.
using SourceHeights = std::function<std::vector<std::optional<double>>(
    std::span<const glm::dvec2> latitudes_longitudes)>;

/// What buildings stand on.
struct BuildingGround {
    const scene::TerrainSurface& surface;
    SourceHeights heights = {}; ///< of a source that is finer than the surface; may be empty
    bool with_levels = false;   ///< makes levels of detail of the buildings
};

/// Adds the buildings of files of outlines. On georeferenced terrain the files are transformed; on
/// other terrain, corners are x and y in scene metres. Leaves out, with one note a file, what does
/// not stand wholly on ground, and what has no height that a building may have. One note counts
/// flat roofs of buildings with roof=hipped. Fails as io::read_footprints, as io::TileSet::open
/// of a surface model, and if no building is left.
Result<PlacedBuildings> add_buildings(scene::Scene& scene, const BuildingGround& ground,
                                      const std::vector<io::FootprintsDescription>& files,
                                      const std::stop_token& stop);

/// A generated city as heights, to place cameras (terrains::City::heights); null without any.
Result<std::shared_ptr<const scene::TerrainSurface>>
city_surface(Grid<float> heights, glm::dvec2 spacing, const scene::TerrainOptions& options);

/// Adds the buildings of a generated city, whose streets lie at z = 0.
Result<scene::Node*> add_city(scene::Scene& scene,
                              const std::vector<building::PaintedFaces>& buildings,
                              bool with_levels);

/// Puts the buildings on another surface of the same terrain.
void stand_on(const scene::TerrainSurface& surface, const PlacedBuildings& buildings);

} // namespace reljef::session
