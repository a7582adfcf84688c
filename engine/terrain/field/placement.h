#pragma once

#include <memory>
#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/geometry.h"
#include "engine/core/result.h"
#include "engine/terrain/field/heightfield.h"
#include "engine/terrain/field/tile_lattice.h"

namespace reljef::terrain {

/// Larger factors leave too little precision.
inline constexpr double max_exaggeration = 1e6;

/// Metres between samples. Positions on the Earth err by up to 1e-8 m (LocalFrame), which is then a
/// ten-thousandth of a sample. Rays over closer samples are never straight in their coordinates.
inline constexpr double min_spacing_on_ellipsoid = 1e-4;

enum class PlacementKind { plane, ellipsoid };

/// Maps samples of a heightfield (col, row, height in true metres) to the scene frame (metres, x
/// east, y north, z up). Plane: x = (col − middle.col)·dx, y = (middle.row − row)·dy,
/// z = height·exaggeration, where the middle is that of the source, whatever its reduction.
/// Ellipsoid: the WGS 84 position with height·exaggeration above the ellipsoid, or above the
/// georeference's geoid, in the local frame at the middle. Cheap to copy.
class Placement {
public:
    /// Errors: an ellipsoid without a georeference or with samples too close for it, an
    /// exaggeration out of range.
    static Result<Placement> create(const Heightfield& heightfield, PlacementKind kind,
                                    double exaggeration = 1.0);

    /// Of a tile of the terrain whose overview this placement places; in the same scene frame.
    [[nodiscard]] Placement of_tile(const Reduction& reduction, const TileLattice& tile) const;

    /// Where the samples lie among those of the terrain; null: this is not the placement of a tile.
    [[nodiscard]] const TileLattice* lattice() const { return tile_ ? &tile_->lattice : nullptr; }
    /// The sample of the terrain for a sample of its tile; the sample itself without a tile.
    [[nodiscard]] glm::dvec2 on_terrain(glm::dvec2 sample) const {
        return tile_ ? tile_->lattice.on_terrain(sample) : sample;
    }

    /// The same, with the row as WrappedRows::even_row: linear in each cell of a tile.
    [[nodiscard]] glm::dvec2 on_even_rows(glm::dvec2 sample) const {
        return tile_ ? tile_->lattice.on_even_rows(sample) : sample;
    }

    [[nodiscard]] PlacementKind kind() const {
        return frame_ ? PlacementKind::ellipsoid : PlacementKind::plane;
    }
    [[nodiscard]] double exaggeration() const { return exaggeration_; }
    [[nodiscard]] glm::dvec2 spacing() const { return spacing_; } ///< metres between samples

    /// The scene frame's place on the Earth; null: a plane.
    [[nodiscard]] const geo::LocalFrame* frame() const { return frame_ ? &*frame_ : nullptr; }
    /// Bounds of the geoid's height above the ellipsoid over the terrain, metres; 0 without one.
    [[nodiscard]] HeightRange zero_range() const { return zero_range_; }
    /// Of a terrain on the ellipsoid that is even in degrees, without a geoid; otherwise, and of a
    /// tile, empty.
    [[nodiscard]] std::optional<geo::DegreeGrid> degree_grid() const;
    /// South and north of a terrain that covers all longitudes, degrees; otherwise empty.
    [[nodiscard]] std::optional<glm::dvec2> latitudes_all_around() const;
    [[nodiscard]] bool has_geoid() const { return geoid_.has_value(); }
    /// The same with heights above the ellipsoid.
    [[nodiscard]] Placement without_geoid() const;
    /// The geoid's height above the ellipsoid at a sample, metres; 0 without one. Precondition: on
    /// the ellipsoid.
    [[nodiscard]] double zero_at_sample(glm::dvec2 sample) const;
    /// Columns around a terrain that covers all longitudes; otherwise empty.
    [[nodiscard]] std::optional<double> columns_all_around() const;

    [[nodiscard]] glm::dvec3 world_from_sample(glm::dvec3 sample) const;
    /// The inverse; may lie outside the heightfield. Empty outside the map's domain.
    [[nodiscard]] std::optional<glm::dvec3> sample_from_world(glm::dvec3 world) const;
    /// Unit vector along the local vertical.
    [[nodiscard]] glm::dvec3 up(glm::dvec3 world) const;
    /// Horizontal unit vector towards true north; y without a georeference.
    [[nodiscard]] glm::dvec3 north(glm::dvec3 world) const;

    /// WGS 84 with the height in true metres. Empty without a georeference or outside the map's
    /// domain.
    [[nodiscard]] std::optional<geo::Geodetic> geodetic_from_world(glm::dvec3 world) const;
    [[nodiscard]] std::optional<glm::dvec3> world_from_geodetic(geo::Geodetic position) const;

private:
    // A tile among the samples of the placed overview.
    struct TilePlace {
        Reduction reduction;
        TileLattice lattice;
    };
    Placement() = default;
    [[nodiscard]] glm::dvec2 placed(glm::dvec2 sample) const {
        return tile_ ? tile_->reduction.on_overview(on_terrain(sample)) : sample;
    }
    [[nodiscard]] glm::dvec2 from_placed(glm::dvec2 sample) const {
        return tile_ ? tile_->lattice.from_terrain(tile_->reduction.from_overview(sample)) : sample;
    }
    /// Geoid height above the ellipsoid, metres; 0 without a geoid.
    [[nodiscard]] double zero_at(glm::dvec2 latitude_longitude) const;
    [[nodiscard]] HeightRange find_zero_range() const;

    glm::dvec2 middle_{0.0};  // col, row: the origin of the scene
    glm::dvec2 last_{0.0};    // col, row
    glm::dvec2 spacing_{1.0}; // metres
    double exaggeration_ = 1.0;
    std::shared_ptr<const geo::GeodeticMap> geodetic_; // null: no georeference
    std::optional<geo::LocalFrame> frame_;             // ellipsoid only
    std::optional<geo::Geoid> geoid_;                  // ellipsoid only
    HeightRange zero_range_;
    std::optional<TilePlace> tile_;
};

} // namespace reljef::terrain
