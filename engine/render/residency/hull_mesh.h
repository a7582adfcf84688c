#pragma once

#include <array>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "engine/scene/graph/surface_detail.h"

namespace reljef::render {

/// A tetrahedron of a hull: an instance of relief_hull.vert. Corners 1, 2 and 3 are clockwise as
/// seen from corner 0.
struct HullPart {
    std::array<glm::vec4, 4> corners;     ///< xyz: local metres; w: height of the tile
    std::array<glm::vec4, 2> coordinates; ///< texture coordinates of corners 0 and 1, 2 and 3
    /// xyz: the mesh's normals at the corners; w: 1 if the side opposite the corner lies on a hard
    /// edge of the mesh.
    std::array<glm::vec4, 4> normals;
};
static_assert(sizeof(HullPart) == 160);

/// The hull between a mesh moved to the lowest and to the highest relief height, plus a margin: a
/// prism over each triangle, cut into three tetrahedra. Neighbours share whole sides (Porumbescu,
/// Budge, Feng and Joy 2005). At hard edges vertices move equally far along both normals
/// (scene::SharedPlace), and the texture continues beyond the triangle in its plane; with discard
/// they do not. Omits parts without a volume.
std::vector<HullPart> hull_parts(const scene::Mesh& mesh, const scene::SurfaceDetail& detail);

} // namespace reljef::render
