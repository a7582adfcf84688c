#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/material/relief_material.h"
#include "engine/scene/graph/mesh.h"

namespace reljef::scene {

/// A repeated detail tile on a mesh.
struct SurfaceDetail {
    std::shared_ptr<const material::ReliefMaterial> set; ///< as completed() returned it
    glm::vec2 repeats{1.0F}; ///< tiles per unit of texture coordinates; > 0
    float scale = 0.05F;     ///< height of 1, in tile widths; > 0
    /// Added to the heights, in [−1, 0]: −1 puts all below the mesh, 0 all above.
    float offset = -1.0F;
    material::WrapMode border = material::WrapMode::wrap;

    friend bool operator==(const SurfaceDetail&, const SurfaceDetail&) = default;
};

/// Side of a square with the mean area of a tile on the mesh, metres; 0 if the texture coordinates
/// have no area.
double tile_width(const Mesh& mesh, glm::vec2 repeats);

/// Displacement by a height of 1, metres.
double relief_height(const Mesh& mesh, const SurfaceDetail& detail);

/// Largest displacement of a vertex by height 1: at an edge it is longer, to keep the distance from
/// each face (see SharedPlace).
inline constexpr double max_lift = 2.0;

/// Upper bound of what displacement adds to a mesh's bounds, metres.
double raised_above(const Mesh& mesh, const SurfaceDetail& detail);

/// Upper bound of what a hull adds to a mesh's bounds, metres. The hull reaches `hull_margin`
/// beyond the lowest and the highest height.
double hull_reach(const Mesh& mesh, const SurfaceDetail& detail);
inline constexpr double hull_margin = 1.0 / 4096.0;

/// Divides each triangle into n² with interpolated unit normals. Shared edges stay shared.
/// Precondition: n >= 1.
Mesh tessellated(const Mesh& mesh, int n);

/// The parts of each edge so that vertices are at most `texels` of the heights apart, with at most
/// max_displaced_triangles. Precondition: the detail has a set.
int cuts_for(const Mesh& mesh, const SurfaceDetail& detail, double texels);
inline constexpr std::size_t max_displaced_triangles = 1'000'000;

/// The positions displaced by the heights at their texture coordinates. Vertices at one place stay
/// together: by the mean of their heights, along SharedPlace::direction.
std::vector<glm::vec3> displaced_positions(const Mesh& mesh, const SurfaceDetail& detail);

struct SharedPlace {
    std::uint32_t index = 0;   ///< the same for all vertices at one place
    glm::dvec3 direction{0.0}; ///< of displacement by 1: the same distance along each normal
};
/// One for each vertex.
std::vector<SharedPlace> shared_places(const Mesh& mesh);

/// Height in [0,1] at a tile coordinate, bilinear between texel centres, as GL samples. `discard`
/// continues the border.
double tile_height(const material::ReliefMaterial& set, glm::dvec2 coordinate,
                   material::WrapMode border);

} // namespace reljef::scene
