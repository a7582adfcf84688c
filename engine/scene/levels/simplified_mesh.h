#pragma once

#include <cstddef>

#include "engine/scene/graph/mesh.h"

namespace reljef::scene {

/// A mesh with fewer triangles: edges are collapsed into one of their ends (Garland and Heckbert
/// 1997), so its corners are places of `mesh`. Where several corners of it meet with different
/// normals, each triangle takes the normal that fits it best. Open borders stay, so that parts of
/// an object still meet. Has about `triangles` triangles, more if no further edge can be collapsed.
Mesh simplified_mesh(const Mesh& mesh, std::size_t triangles);

} // namespace reljef::scene
