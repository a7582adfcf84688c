#pragma once

#include <cstddef>

#include "engine/scene/graph/mesh.h"

namespace reljef::scene {

/// What of a mesh must stay where corners meet at one place with different attributes.
enum class Seams {
    kept,  ///< texture coordinates and normals: such corners may not move freely
    joined ///< only places: each corner has the normal there that fits its triangle best
};

/// A mesh with fewer triangles: edges are collapsed into one of their ends (Garland and Heckbert
/// 1997), so its corners are places of `mesh`. Open borders stay, so that parts of an object still
/// meet. Has about `triangles` triangles, more if no further edge can be collapsed.
Mesh simplified_mesh(const Mesh& mesh, std::size_t triangles, Seams seams);

} // namespace reljef::scene
