#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "engine/core/geometry.h"
#include "engine/core/result.h"
#include "engine/material/cone_map.h"
#include "engine/scene/graph/surface_detail.h"
#include "engine/scene/technique/technique.h"
#include "engine/scene/technique/terrain_detail.h"
#include "engine/terrain/field/heightfield.h"
#include "engine/terrain/field/min_max_pyramid.h"
#include "engine/terrain/field/placement.h"
#include "engine/terrain/field/surface_caster.h"
#include "engine/terrain/mesh/bisection.h"
#include "engine/terrain/mesh/tile_layout.h"

namespace reljef::scene {

/// How a surface looks.
struct Material {
    Technique technique{Polygons{}};
    bool wireframe = false;
    glm::vec3 color{0.8F}; ///< linear albedo, meshes only; a terrain brings its own
    SurfaceDetail detail;  ///< meshes only; without a set the mesh is of one colour

    friend bool operator==(const Material&, const Material&) = default;
};

/// The tile of detail as it is drawn: what the technique says of its border comes first.
SurfaceDetail shown_detail(const Material& material);

/// Whether a mesh is drawn with its inner side.
bool is_seen_from_behind(const Material& material);

struct TerrainOptions {
    /// Absent: ellipsoid for georeferenced heights, else plane.
    std::optional<terrain::PlacementKind> placement;
    double exaggeration = 1.0;
};

/// A terrain placed in a node's local frame (metres, x east, y north, z up), ready to be drawn and
/// asked. The data is shared and never changes.
class TerrainSurface {
public:
    static Result<TerrainSurface> create(std::shared_ptr<const terrain::Terrain> terrain,
                                         const TerrainOptions& options = {});

    [[nodiscard]] const terrain::Terrain& terrain() const { return *terrain_; }
    [[nodiscard]] const terrain::Heightfield& heightfield() const { return terrain_->heightfield; }
    [[nodiscard]] const terrain::Placement& placement() const { return placement_; }
    [[nodiscard]] const terrain::MinMaxPyramid& pyramid() const { return pyramid_; }

    /// Tiles of the surface, and of the flat reference surface, with the same indices.
    [[nodiscard]] const std::vector<terrain::Tile>& tiles() const { return tiles_; }
    [[nodiscard]] const std::vector<terrain::Tile>& flat_tiles() const { return flat_tiles_; }
    [[nodiscard]] const Box& bounds() const { return bounds_; }

    /// z of the surface straight above or below (x, y) in the local frame, exaggeration included;
    /// nothing outside the heightfield.
    [[nodiscard]] std::optional<double> height_at(double x, double y) const;

    /// Where a ray in the local frame first meets the surface.
    [[nodiscard]] std::optional<terrain::SurfaceHit> pick(const Ray& ray) const;

private:
    TerrainSurface(std::shared_ptr<const terrain::Terrain> terrain, terrain::Placement placement);

    std::shared_ptr<const terrain::Terrain> terrain_;
    terrain::Placement placement_;
    terrain::MinMaxPyramid pyramid_;
    std::vector<terrain::Tile> tiles_;
    std::vector<terrain::Tile> flat_tiles_;
    Box bounds_;
};

/// Whether the technique can draw the surface. Fails, with the reason and the name of what works,
/// where a technique is one for meshes, where one that looks for the surface along rays finds it
/// bent over the Earth, and on options that only detail tiles have: two sides, a border that goes
/// on.
Result<void> check_technique(const Technique& technique, const TerrainSurface& surface);

class TileStream;

/// What makes a node a terrain.
struct TerrainNode {
    std::shared_ptr<const TerrainSurface> surface;
    Material material;
    /// Finer tiles of the same terrain, which is an overview then; null: it is all there is.
    std::shared_ptr<TileStream> stream = {};
    /// Shown where the technique is polygons; null: none.
    std::shared_ptr<const TerrainDetail> detail = {};
    /// Of the surface, where they were made or read before; null: made when they are first needed.
    std::shared_ptr<const terrain::Bisection> bisection = {};
    std::shared_ptr<const material::ConeMaps> cones = {}; ///< over its heights, from 0 to 1

    friend bool operator==(const TerrainNode&, const TerrainNode&) = default;
};

/// Whether the technique draws the tiles of a stream; else it draws the overview.
bool draws_tiles(const Technique& technique);

} // namespace reljef::scene
