#pragma once

#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/geometry.h"
#include "engine/core/result.h"
#include "engine/terrain/field/heightfield.h"

namespace reljef::terrain {

/// Of the heights; more would leave nothing of a terrain's shape, and less precision than is shown.
inline constexpr double largest_exaggeration = 1e6;

enum class PlacementKind { plane, ellipsoid };

/// Where the samples of a heightfield stand in the scene frame (metres, x east, y north, z up).
/// A sample is (col, row, height in true metres). Plane: x = (col − (cols−1)/2)·dx,
/// y = ((rows−1)/2 − row)·dy, z = height·exaggeration. Ellipsoid: the WGS 84 position, with height·
/// exaggeration above the ellipsoid, or above the geoid where the georeference has one, in the
/// local frame at the centre of the heightfield.
class Placement {
public:
    /// Plane, or ellipsoid; fails when an ellipsoid is asked for without a georeference, or the
    /// exaggeration is not a finite number > 0. `heightfield` is read now and not kept.
    static Result<Placement> create(const Heightfield& heightfield, PlacementKind kind,
                                    double exaggeration = 1.0);

    [[nodiscard]] PlacementKind kind() const;
    [[nodiscard]] double exaggeration() const { return exaggeration_; }

    [[nodiscard]] glm::dvec3 world_from_sample(glm::dvec3 sample) const;
    /// The sample below, at or above a world position; nothing where the Earth's other side or the
    /// map's own limits leave none. May lie outside the heightfield.
    [[nodiscard]] std::optional<glm::dvec3> sample_from_world(glm::dvec3 world) const;
    /// Unit vector away from the Earth at a world position.
    [[nodiscard]] glm::dvec3 up(glm::dvec3 world) const;

    /// Unit vector towards true north at a world position, level there: on a plane that of the map.
    /// Without a georeference y.
    [[nodiscard]] glm::dvec3 north(glm::dvec3 world) const;

    /// WGS 84, with the height in true metres; nothing without a georeference, and on a plane
    /// beside the map, where a latitude would be beyond the poles or no number.
    [[nodiscard]] std::optional<geo::Geodetic> geodetic_from_world(glm::dvec3 world) const;
    [[nodiscard]] std::optional<glm::dvec3> world_from_geodetic(geo::Geodetic position) const;

private:
    Placement() = default;
    /// Of the heights' zero above the ellipsoid, metres; 0 where the geoid is not known.
    [[nodiscard]] double zero_at(glm::dvec2 latitude_longitude) const;

    glm::dvec2 center_{0.0};  // col, row
    glm::dvec2 spacing_{1.0}; // metres
    double exaggeration_ = 1.0;
    std::optional<geo::GeodeticMap> geodetic_;
    std::optional<geo::LocalFrame> frame_; // ellipsoid only
    std::optional<geo::Geoid> geoid_;      // ellipsoid only
};

} // namespace reljef::terrain
