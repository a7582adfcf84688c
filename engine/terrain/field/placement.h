#pragma once

#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/geometry.h"
#include "engine/core/result.h"
#include "engine/terrain/field/heightfield.h"

namespace reljef::terrain {

/// Larger factors leave too little precision.
inline constexpr double max_exaggeration = 1e6;

enum class PlacementKind { plane, ellipsoid };

/// Maps samples of a heightfield (col, row, height in true metres) to the scene frame (metres, x
/// east, y north, z up). Plane: x = (col − (cols−1)/2)·dx, y = ((rows−1)/2 − row)·dy,
/// z = height·exaggeration. Ellipsoid: the WGS 84 position with height·exaggeration above the
/// ellipsoid, or above the georeference's geoid, in the local frame at the centre.
class Placement {
public:
    /// Errors: an ellipsoid without a georeference, an exaggeration out of range.
    static Result<Placement> create(const Heightfield& heightfield, PlacementKind kind,
                                    double exaggeration = 1.0);

    [[nodiscard]] PlacementKind kind() const {
        return frame_ ? PlacementKind::ellipsoid : PlacementKind::plane;
    }
    [[nodiscard]] double exaggeration() const { return exaggeration_; }

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
    Placement() = default;
    /// Geoid height above the ellipsoid, metres; 0 without a geoid.
    [[nodiscard]] double zero_at(glm::dvec2 latitude_longitude) const;

    glm::dvec2 center_{0.0};  // col, row
    glm::dvec2 spacing_{1.0}; // metres
    double exaggeration_ = 1.0;
    std::optional<geo::GeodeticMap> geodetic_;
    std::optional<geo::LocalFrame> frame_; // ellipsoid only
    std::optional<geo::Geoid> geoid_;      // ellipsoid only
};

} // namespace reljef::terrain
