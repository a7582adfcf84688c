#pragma once

#include <optional>

#include "engine/core/parallel_for.h"
#include "engine/scene/graph/mesh.h"
#include "engine/scene/graph/mesh_pick.h"

namespace reljef::scene {

/// An upper bound for the distance of each point of `from` to the nearest point of another mesh,
/// metres: proven for all points of the triangles, not sampled. Usually at most an eighth over the
/// largest distance, or `enough` if that is larger, and what floats of the places resolve; more
/// where a triangle would take over 4096 pieces to tell. Empty if stopped. `to`: the tree of a mesh
/// with triangles.
std::optional<double> max_distance(const Mesh& from, const MeshTree& to, double enough,
                                   const ParallelOptions& options = {});

/// The larger one of both directions (Hausdorff distance), in the same way. Both have triangles.
std::optional<double> max_distance_between(const Mesh& a, const Mesh& b,
                                           const ParallelOptions& options = {});

/// The longest edge of a triangle of a coarse mesh on which light would fall visibly otherwise than
/// on the fine one: in the middle of one of its triangles, normals differ by over 0.2 radians.
/// Sampled, not proven. Metres; empty if stopped.
std::optional<double> width_of_other_normals(const Mesh& fine, const Mesh& coarse,
                                             const ParallelOptions& options = {});

} // namespace reljef::scene
