#pragma once

#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/grid.h"
#include "engine/terrain/field/heightfield.h"
#include "engine/terrain/field/placement.h"

namespace reljef::terrain {

/// Positions of samples, fast and in little memory: exact on a plane. On an ellipsoid they are
/// bilinear between samples that are up to 32 apart.
class SamplePositions {
public:
    /// `curvature` bounds the second derivative of positions in any direction, metres/sample².
    /// `max_error`: of positions on an ellipsoid, metres, as far as distant samples cause it.
    SamplePositions(const Heightfield& heightfield, const Placement& placement, double curvature,
                    double max_error);

    /// Bounds the distance from the position that the placement gives, metres.
    [[nodiscard]] double error() const { return error_; }

    /// Scene metres. Precondition: a sample of the heightfield; `height` is within its range.
    [[nodiscard]] glm::dvec3 at(glm::ivec2 sample, double height) const {
        return anchors_.empty()
                   ? glm::dvec3(x_[static_cast<std::size_t>(sample.x)],
                                y_[static_cast<std::size_t>(sample.y)], height * exaggeration_)
                   : between_anchors(sample, height);
    }

private:
    struct Anchor {
        glm::dvec3 ground{0.0}; // at height 0, metres
        glm::dvec3 up{0.0};     // metres per metre of height
    };
    // A column or row among those of the anchors.
    struct Between {
        int before = 0;
        double part = 0.0; // of the way to the next
    };
    static std::vector<Between> places_between(const std::vector<int>& lines);
    [[nodiscard]] glm::dvec3 between_anchors(glm::ivec2 sample, double height) const;

    double exaggeration_;
    double error_ = 0.0;
    std::vector<double> x_; // of columns on a plane, metres
    std::vector<double> y_; // of rows
    std::vector<Between> cols_;
    std::vector<Between> rows_;
    Grid<Anchor> anchors_; // empty on a plane
};

} // namespace reljef::terrain
