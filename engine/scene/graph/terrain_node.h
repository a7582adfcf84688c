#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/core/result.h"
#include "engine/material/cone_map.h"
#include "engine/scene/graph/surface_detail.h"
#include "engine/scene/graph/surface_shader.h"
#include "engine/scene/streaming/terrain_surface.h"
#include "engine/scene/technique/technique.h"
#include "engine/terrain/mesh/bisection.h"

namespace reljef::scene {

struct Material {
    Technique technique{Polygons{}};
    bool wireframe = false;
    glm::vec3 color{0.8F}; ///< linear albedo, meshes only; a terrain has its own
    SurfaceDetail detail;  ///< meshes only; without a set the mesh has one colour
    /// Null: none. Precondition: shader->check(constants). Constants without a value here have that
    /// of the shader.
    std::shared_ptr<const SurfaceShader> shader = {};
    std::vector<ShaderConstant> constants = {};

    friend bool operator==(const Material&, const Material&) = default;
};

/// The detail with the border that the technique names.
SurfaceDetail visible_detail(const Material& material);

/// Whether the inner side of a mesh is drawn, too.
bool is_seen_from_behind(const Material& material);

/// Fails if the technique cannot draw the surface, with the reason and a technique that can:
/// techniques for meshes, rays on the ellipsoid, and options that only detail tiles have.
Result<void> check_technique(const Technique& technique, const TerrainSurface& surface);

/// A detail tile that repeats over a terrain drawn as polygons, below the plane of each triangle.
/// It fades with distance and does not change hits.
struct TerrainDetail {
    std::shared_ptr<const material::ReliefMaterial> set; ///< as completed() returned it
    double width = 4.0;            ///< of a tile, metres, [terrain::min_tile_width, max_tile_width]
    float scale = 0.05F;           ///< height of 1, in tile widths; (0, terrain::max_tile_scale]
    Technique technique{Relief{}}; ///< see check_terrain_detail_technique
};

/// Fails if a technique cannot show a detail tile on a terrain, with the reason and techniques that
/// can. Only the options `steps` and `shadow` are allowed.
Result<void> check_terrain_detail_technique(const Technique& technique);

/// No picture shows closer lines, metres.
inline constexpr double min_contours = 1e-3;
/// The largest distance of contours, metres: no terrain is as high.
inline constexpr double max_contours = 1e6;

/// TerrainNode::grain, at most.
inline constexpr double max_grain = 2.0;

class TileStream;

struct MeshNode;

struct TerrainNode {
    std::shared_ptr<const TerrainSurface> surface;
    Material material;
    /// Finer tiles of the same terrain; the surface is their overview. Null: none.
    std::shared_ptr<TileStream> stream = {};
    std::shared_ptr<const TerrainDetail> detail = {}; ///< for polygons only; null: none
    /// Contrast of fine structure on near ground that the data do not have (material::GrainMap),
    /// [0, max_grain]; 0: none, 1: as in nature. It does not change hits.
    float grain = 0.0F;
    /// Metres of height from one line to the next, min_contours to max_contours; 0: none.
    double contours = 0.0;
    bool labels_contours = true; ///< bold lines have their height, see view::contour_labels()
    bool hides_overlay = false;  ///< no grain, contours and façades: to compare with the truth
    /// Triangles with an error bound, for its tiles together; more are drawn with larger errors.
    std::size_t max_triangles = std::numeric_limits<std::size_t>::max();
    /// Samples of a terrain in memory that may all be vertices; see triangle_bound().
    std::size_t max_vertices = std::numeric_limits<std::size_t>::max();
    /// Prepared maps of the surface; null: the renderer makes them on demand.
    std::shared_ptr<const terrain::Bisection> bisection = {};
    std::shared_ptr<const material::ConeMaps> cones = {}; ///< over its heights, from 0 to 1
    /// Walls below its border (terrain_base.h), of one colour. Hits do not show them. Null: none.
    std::shared_ptr<const MeshNode> base = {};

    friend bool operator==(const TerrainNode&, const TerrainNode&) = default;
};

inline float shown_grain(const TerrainNode& terrain) {
    return terrain.hides_overlay ? 0.0F : terrain.grain;
}
inline double shown_contours(const TerrainNode& terrain) {
    return terrain.hides_overlay ? 0.0 : terrain.contours;
}

/// The error bound of triangles that stand in for those of every sample, pixels.
inline constexpr double bound_for_many_samples = 0.5;

/// The error bound of a terrain's triangles, pixels: the technique's. If it draws every sample, and
/// memory does not hold all as vertices, bound_for_many_samples. 0: none.
double triangle_bound(const TerrainNode& terrain, const Technique& technique);

/// Whether the technique shows heights at their true places, so that walls may join the border.
bool shows_heights(const Technique& technique);

/// Whether the technique draws the tiles of a stream; others draw the overview.
bool draws_tiles(const Technique& technique);

/// As TerrainSurface::height_at, of the finest loaded tile.
std::optional<double> height_at(const TerrainNode& terrain, double x, double y);

} // namespace reljef::scene
