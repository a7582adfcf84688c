#pragma once

#include <array>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "engine/scene/graph/surface_detail.h"

namespace reljef::render {

/// A tetrahedron of a hull, as an instance of relief_hull.vert. Corners 1, 2 and 3 are seen
/// clockwise from corner 0.
struct HullPart {
    std::array<glm::vec4, 4> corners;     ///< xyz: local metres; w: height of the tile
    std::array<glm::vec4, 2> coordinates; ///< of the texture, of corners 0 and 1, 2 and 3
    /// Of the mesh, at the corners; w: 1 where beyond the side across from the corner is another
    /// face of the mesh, whose normals part from this one's.
    std::array<glm::vec4, 4> normals;
};
static_assert(sizeof(HullPart) == 160);

/// The hull between a mesh moved to the tile's lowest place and to its highest, a little more each
/// way: over each triangle a prism, cut into three tetrahedra. Neighbours share their sides whole
/// (Porumbescu, Budge, Feng and Joy 2005), also over edges where normals part: there vertices move
/// as far along each of them (scene::SharedPlace), and the texture goes on beyond the triangle in
/// its plane; not so where nothing is beyond the tile (discard). Parts without a volume are left
/// out.
std::vector<HullPart> hull_parts(const scene::Mesh& mesh, const scene::SurfaceDetail& detail);

} // namespace reljef::render
