#pragma once

#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/geometry.h"
#include "engine/geo/georeference.h"
#include "engine/terrain/field/placement.h"

namespace reljef::cast {

/// The samples of a terrain on the ellipsoid, and how large they are. Rows are even
/// (geo::WrappedRows::even_row): those that close a globe at its poles are at their distance.
class EarthMap {
public:
    /// `rows`: of the placement's georeference. `samples`: what is seen, and metres of height.
    EarthMap(const terrain::Placement& placement, const geo::WrappedRows& rows, const Box& samples);

    [[nodiscard]] const terrain::Placement& placement() const { return placement_; }

    [[nodiscard]] glm::dvec3 world(glm::dvec3 sample) const;
    /// The inverse; may lie beside the terrain. Empty outside the map's domain.
    [[nodiscard]] std::optional<glm::dvec3> sample(glm::dvec3 world) const;
    /// Placement::zero_at_sample
    [[nodiscard]] double zero_at(glm::dvec2 sample) const;

    /// Of a column, a row and a metre of height, at most. Between two rows, if the columns are
    /// meridians; else anywhere.
    [[nodiscard]] glm::dvec3 metres_a_sample(Interval rows) const;
    /// Columns around the Earth, if they are meridians; else 0.
    [[nodiscard]] double columns_around() const;
    /// Rows at least one from both poles, if the columns are meridians; else all.
    [[nodiscard]] Interval rows_between_poles() const;

private:
    // Where rows are parallels, equally far apart, and columns are meridians.
    struct Parallels {
        double latitude = 0.0; // of row 0, degrees
        double row_step = 0.0; // degrees
        double column_step = 0.0;
    };
    [[nodiscard]] glm::dvec3 largest_metres(const Box& samples) const;
    [[nodiscard]] std::optional<Parallels> parallels(const Box& samples) const;

    terrain::Placement placement_;
    geo::WrappedRows rows_;
    glm::dvec3 largest_{1.0}; // metres
    std::optional<Parallels> parallels_;
    double equator_ = 0.0; // metres of a column there
};

} // namespace reljef::cast
