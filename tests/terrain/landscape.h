#pragma once

#include <string>
#include <utility>

#include "engine/terrain/field/min_max_pyramid.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::test {

/// A placed heightfield and what looks for hidden ground needs.
struct Landscape {
    Landscape(std::string named, terrain::Heightfield made, double exaggeration = 1.0)
        : name(std::move(named)), heightfield(std::move(made)),
          placement(placed(heightfield, exaggeration)), pyramid(heightfield.heights.view()) {}
    Landscape(const Landscape&) = delete;
    Landscape& operator=(const Landscape&) = delete;

    [[nodiscard]] glm::ivec2 samples() const {
        return {heightfield.heights.cols(), heightfield.heights.rows()};
    }
    /// Scene metres, `above` metres above the ground.
    [[nodiscard]] glm::dvec3 at(glm::dvec2 sample, double above = 0.0) const {
        const double height = terrain::bilinear_height(heightfield.heights.view(), sample);
        return placement.world_from_sample({sample, height + above / placement.exaggeration()});
    }

    std::string name;
    terrain::Heightfield heightfield;
    terrain::Placement placement;
    terrain::MinMaxPyramid pyramid;
};

} // namespace reljef::test
