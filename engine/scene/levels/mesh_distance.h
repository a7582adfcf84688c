#pragma once

#include <optional>

#include "engine/core/parallel_for.h"
#include "engine/scene/graph/mesh.h"
#include "engine/scene/graph/mesh_pick.h"

namespace reljef::scene {

/// An upper bound for the distance of each point of `from` to the nearest point of another mesh,
/// metres: proven for all points of the triangles, not sampled. At most an eighth over the largest
/// distance, or over `enough` if that is larger; more only where pieces become smaller than floats
/// of the mesh resolve. Empty if stopped. `to`: the tree of a mesh with triangles.
std::optional<double> max_distance(const Mesh& from, const MeshTree& to, double enough,
                                   const ParallelOptions& options = {});

/// The larger one of both directions (Hausdorff distance), in the same way. Both have triangles.
std::optional<double> max_distance_between(const Mesh& a, const Mesh& b,
                                           const ParallelOptions& options = {});

} // namespace reljef::scene
