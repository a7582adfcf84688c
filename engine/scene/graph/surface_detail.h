#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/material/relief_material.h"
#include "engine/scene/graph/mesh.h"

namespace reljef::scene {

/// A tile of detail on a mesh: how often, how high, and what lies beyond it.
struct SurfaceDetail {
    std::shared_ptr<const material::ReliefMaterial> set; ///< as completed() gave it
    glm::vec2 repeats{1.0F}; ///< tiles along texture coordinates 0 … 1; > 0
    float scale = 0.05F;     ///< height of 1, in tile widths; > 0
    /// Of the heights against the mesh, in [−1, 0]: −1 sinks all below it, 0 lifts all above.
    float offset = -1.0F;
    material::WrapMode border = material::WrapMode::wrap;

    friend bool operator==(const SurfaceDetail&, const SurfaceDetail&) = default;
};

/// Side of the square as large as one tile is on the mesh, on average, metres; 0 where the texture
/// coordinates cover nothing.
double tile_width(const Mesh& mesh, glm::vec2 repeats);

/// Metres that a height of 1 lifts a point of the mesh.
double relief_height(const Mesh& mesh, const SurfaceDetail& detail);

/// A vertex that is lifted by 1 goes no farther: over an edge as far as each of its faces needs,
/// see SharedPlace, but no spike is longer.
inline constexpr double max_lift = 2.0;

/// Metres that displacement adds to a mesh's bounds, at most.
double raised_above(const Mesh& mesh, const SurfaceDetail& detail);

/// Metres that a hull around all heights adds to a mesh's bounds, at most: a height by hull_margin
/// beyond the lowest and the highest.
double hull_reach(const Mesh& mesh, const SurfaceDetail& detail);
inline constexpr double hull_margin = 1.0 / 4096.0;

/// The mesh with every triangle cut into n², its vertices' normals unit vectors between the
/// corners'. Edges that two triangles share stay shared. Precondition: n >= 1.
Mesh tessellated(const Mesh& mesh, int n);

/// Into how many parts each edge is cut so that vertices lie no more than `texels` of the heights
/// apart, and there are no more than max_displaced_triangles. Precondition: a set is there.
int cuts_for(const Mesh& mesh, const SurfaceDetail& detail, double texels);
inline constexpr std::size_t max_displaced_triangles = 1'000'000;

/// The positions moved along the normals to the heights at their texture coordinates. Vertices at
/// one place stay together: they share the mean of their heights, and go along the mean of their
/// normals, as far along each as they would alone.
std::vector<glm::vec3> displaced_positions(const Mesh& mesh, const SurfaceDetail& detail);

/// Where a vertex stands, and where it goes that is lifted by 1.
struct SharedPlace {
    std::uint32_t index = 0;   ///< the same of all vertices at one place
    glm::dvec3 direction{0.0}; ///< likewise: as far along each of their normals
};
/// Of each vertex.
std::vector<SharedPlace> shared_places(const Mesh& mesh);

/// Height in [0,1] at a tile's coordinate, bilinear between texel centres, as GL samples; beyond
/// the tile (discard) the border's.
double tile_height(const material::ReliefMaterial& set, glm::dvec2 coordinate,
                   material::WrapMode border);

} // namespace reljef::scene
