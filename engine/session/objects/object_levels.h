#pragma once

#include <memory>
#include <vector>

#include "engine/core/parallel_for.h"
#include "engine/core/result.h"
#include "engine/session/objects/placed_objects.h"

namespace reljef::session {

using ObjectMesh = std::shared_ptr<const scene::Mesh>;

/// The meshes of objects that could have levels of detail (scene/levels) and have none yet, each
/// once. Meshes with pictures keep all triangles: no bound is known for where levels show them.
std::vector<ObjectMesh> meshes_without_levels(const std::vector<PlacedObject>& objects);

/// The levels of a mesh.
struct MadeLevels {
    ObjectMesh mesh;
    std::shared_ptr<const scene::MeshLevels> levels;
};

/// Fails after a stop request.
Result<std::vector<MadeLevels>> make_levels(const std::vector<ObjectMesh>& meshes,
                                            const ParallelOptions& options);

/// Objects are drawn with these levels where the ground keeps an error bound.
void set_levels(const std::vector<PlacedObject>& objects, const std::vector<MadeLevels>& made);

} // namespace reljef::session
