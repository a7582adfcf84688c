#pragma once

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "engine/building/building_faces.h"
#include "engine/core/color.h"
#include "engine/core/result.h"
#include "engine/scene/graph/scene.h"
#include "engine/session/objects/building_levels.h"

namespace reljef::session {

/// A window of a plastered wall, window_bay by window_storey, which repeats.
Image facade_picture();

/// Collects the faces of buildings as few meshes: the walls and the other faces of each square of
/// building_square. Walls show the façade, other faces their colour from a picture of all colours.
class BuildingMeshes {
public:
    /// `world_from_building`: rigid. The building belongs to the square of its origin.
    void add(const building::PaintedFaces& building, const glm::dmat4& world_from_building);

    /// Adds one node for each mesh, with levels of detail if `with_levels`. Fails as
    /// picture_material().
    Result<void> add_to(scene::Node& parent, bool with_levels) const;

    [[nodiscard]] std::size_t triangles() const { return triangles_; }

private:
    struct Square {
        glm::dvec3 origin{0.0};
        scene::Mesh walls;
        scene::Mesh others; ///< u is the index of the colour
        std::vector<BuildingEnd> ends = {};
    };
    std::uint32_t index_of(glm::vec3 color);
    void add(const building::Face& face, std::uint32_t color,
             const glm::dmat4& square_from_building, Square& square);

    std::map<std::pair<int, int>, Square> squares_;
    std::map<std::uint32_t, std::uint32_t> index_by_color_;
    std::vector<Rgba8> colors_;
    std::size_t triangles_ = 0;
};
inline constexpr double building_square = 256.0; ///< metres

} // namespace reljef::session
