#pragma once

#include <cstddef>
#include <optional>

#include "engine/core/parallel_for.h"
#include "engine/scene/graph/mesh.h"

namespace reljef::scene {

/// Meshes with fewer triangles are drawn fast without levels.
inline constexpr std::size_t min_triangles_with_levels = 4096;

/// Ever coarser meshes of a mesh, each with about a quarter of the triangles of the one before, as
/// long as simplified_mesh() finds them; and how far they are from the mesh, proven. None for fewer
/// than min_triangles_with_levels. Empty if stopped.
std::optional<MeshLevels> mesh_levels(const Mesh& mesh, const ParallelOptions& options = {});

} // namespace reljef::scene
