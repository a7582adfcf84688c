#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/geometry.h"
#include "engine/terrain/field/heightfield.h"
#include "engine/terrain/field/min_max_pyramid.h"
#include "engine/terrain/field/placement.h"

namespace reljef::terrain {

/// Metres of the placement's scene frame.
struct HorizonView {
    glm::dvec3 eye{0.0};
    double near = 0.0;   ///< largest distance from the eye to the start of a ray
    double margin = 0.0; ///< radians, >= 0; occluders appear higher than hidden objects by this
};

/// Bounds of the ground (z, scene metres) over a rectangle (x and y, metres). Empty if the ground
/// does not cover the rectangle. Bounds may be too wide.
using GroundRange = std::function<std::optional<HeightRange>(glm::dvec2 low, glm::dvec2 high)>;

/// The part of the ground that a horizon uses.
struct HorizonOptions {
    double first = 1.0;               ///< nearest distance, metres
    double last = 1.0;                ///< farthest distance, metres
    int sectors = 256;                ///< of azimuth, >= 8
    double growth = 1.0 + 1.0 / 16.0; ///< ratio of consecutive distances, > 1
};

/// Conservative occlusion by ground on a plane, seen from an eye above it. For each sector of
/// azimuth and each distance it holds the steepest slope that is certainly hidden, from the lowest
/// height of each stretch. Stretches are evaluated on demand.
class Horizon {
public:
    /// Precondition: the eye is more than view.near above the ground.
    Horizon(GroundRange ground, const HorizonOptions& reach, const HorizonView& view);
    /// Empty on an ellipsoid, or if the eye is not more than view.near above the ground. The
    /// pyramid outlives the horizon.
    static std::optional<Horizon> create(const Heightfield& heightfield,
                                         const MinMaxPyramid& pyramid, const Placement& placement,
                                         const HorizonView& view);

    /// Whether ground that is nearer than the box hides all of it by the margin. Conservative:
    /// false in doubt.
    [[nodiscard]] bool hides(const Box& box);

private:
    double steepest_before(int sector, std::size_t stretch);
    [[nodiscard]] std::optional<double> slope_of(int sector, std::size_t stretch) const;

    GroundRange ground_;
    HorizonView view_;
    double sector_angle_ = 0.0;     // radians
    double rectangle_growth_ = 1.0; // reach of a stretch's bounding rectangle over its radius
    std::vector<double> radii_;     // metres; stretch i lies between radii i and i + 1
    // By sector, as far as evaluated: the steepest slope that is hidden behind stretches 0 … i.
    std::vector<std::vector<double>> sectors_;
};

} // namespace reljef::terrain
