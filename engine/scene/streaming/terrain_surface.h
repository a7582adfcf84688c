#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "engine/core/color.h"
#include "engine/core/geometry.h"
#include "engine/core/result.h"
#include "engine/scene/streaming/terrain_tile.h"
#include "engine/terrain/field/color_ramp.h"
#include "engine/terrain/field/heightfield.h"
#include "engine/terrain/field/min_max_pyramid.h"
#include "engine/terrain/field/placement.h"
#include "engine/terrain/field/surface_caster.h"

namespace reljef::scene {

struct TerrainOptions {
    /// Absent: ellipsoid for georeferenced heights, otherwise plane.
    std::optional<terrain::PlacementKind> placement;
    double exaggeration = 1.0;
    terrain::ColorRamp ramp = *terrain::named_ramp(terrain::default_ramp); ///< where no image lies
    double imagery_share = 1.0; ///< of the terrain's colours, [0, 1]; the rest are the ramp's
    /// Over all other colours, by its alpha; its outermost texels, at least 2 x 2, are the
    /// outermost samples. Null: none.
    std::shared_ptr<const Image> overlay = {};
};

/// A terrain in a node's local frame (metres, x east, y north, z up), for drawing and queries. The
/// data is shared and never changes.
class TerrainSurface {
public:
    static Result<TerrainSurface> create(std::shared_ptr<const terrain::Terrain> terrain,
                                         const TerrainOptions& options = {});

    /// The same terrain with another exaggeration. Fails if the factor is out of range.
    [[nodiscard]] Result<TerrainSurface> exaggerated(double factor) const;
    /// The same terrain with other options. Fails as create().
    [[nodiscard]] Result<TerrainSurface> changed(const TerrainOptions& options) const {
        return create(terrain_, options);
    }
    [[nodiscard]] TerrainOptions options() const;

    [[nodiscard]] const terrain::Terrain& terrain() const { return *terrain_; }
    [[nodiscard]] const terrain::Heightfield& heightfield() const { return terrain_->heightfield; }
    /// Otherwise its samples are averages, and the error of the surface is not known.
    [[nodiscard]] bool has_all_samples() const { return heightfield().reduction <= 1.0; }
    [[nodiscard]] const terrain::Placement& placement() const { return placement_; }
    [[nodiscard]] const terrain::ColorRamp& ramp() const { return ramp_; }
    [[nodiscard]] double imagery_share() const { return imagery_share_; }
    [[nodiscard]] const std::shared_ptr<const Image>& overlay() const { return overlay_; }
    [[nodiscard]] const terrain::MinMaxPyramid& pyramid() const { return pyramid_; }

    /// Row after row. They borrow the samples of this surface.
    [[nodiscard]] const std::vector<std::shared_ptr<const TerrainTile>>& tiles() const {
        return tiles_;
    }
    /// Bounds of the tiles on the flat reference surface, with the same indices.
    [[nodiscard]] const std::vector<Box>& flat_bounds() const { return flat_bounds_; }
    [[nodiscard]] const Box& bounds() const { return bounds_; }

    /// z of the surface at (x, y) in the local frame, exaggeration included; empty outside the
    /// heightfield.
    [[nodiscard]] std::optional<double> height_at(double x, double y) const;

    /// The first hit of a ray in the local frame.
    [[nodiscard]] std::optional<terrain::SurfaceHit> pick(const Ray& ray) const;

private:
    TerrainSurface(std::shared_ptr<const terrain::Terrain> terrain, terrain::Placement placement,
                   const TerrainOptions& options);

    std::shared_ptr<const terrain::Terrain> terrain_;
    terrain::Placement placement_;
    terrain::ColorRamp ramp_;
    double imagery_share_;
    std::shared_ptr<const Image> overlay_;
    terrain::MinMaxPyramid pyramid_;
    std::vector<std::shared_ptr<const TerrainTile>> tiles_;
    std::vector<Box> flat_bounds_;
    Box bounds_;
};

} // namespace reljef::scene
