#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "engine/core/result.h"
#include "engine/io/formats/scene_file.h"
#include "engine/scene/graph/scene.h"

namespace reljef::session {

/// An object of a scene; its node, which the scene owns, holds one mesh for each material.
struct PlacedObject {
    scene::Node* node = nullptr;
    io::ObjectDescription description;
    double lowest = 0.0;                 ///< z of the mesh's lowest point, metres of the file
    std::optional<double> ground_height; ///< true metres from the source; absent: the surface's
};

struct PlacedObjects {
    std::vector<PlacedObject> objects;
    std::vector<std::string> notes; ///< of the files, each once; of objects that show nothing
};

/// Height of the ground at a latitude and longitude, true metres; empty in voids and outside.
using SourceHeight = std::function<std::optional<double>(glm::dvec2 latitude_longitude)>;

/// Adds meshes that stand on the terrain. Each file is read once, and its meshes are shared.
/// `height`: of the source, if the surface is coarser than the ground that is drawn; may be empty.
/// Fails as io::read_mesh_file, and on a place that is no place on Earth or not on the terrain.
Result<PlacedObjects> add_objects(scene::Scene& scene, const scene::TerrainSurface& surface,
                                  const std::vector<io::ObjectDescription>& objects,
                                  const SourceHeight& height, const std::stop_token& stop);

/// Where an object stands: its mesh's z along the local vertical, y turned clockwise from north by
/// the heading. Exaggeration lifts the ground, not the object. Errors begin with the file.
Result<glm::dmat4> scene_from_object(const scene::TerrainSurface& surface,
                                     const PlacedObject& object);

/// Puts objects on another surface of the same terrain.
void stand_on(const scene::TerrainSurface& surface, const std::vector<PlacedObject>& objects);

} // namespace reljef::session
