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

/// Who looks over a terrain, metres of the placement's scene frame.
struct HorizonView {
    glm::dvec3 eye{0.0};
    double near = 0.0;   ///< no ray begins farther from the eye
    double margin = 0.0; ///< radians, >= 0: what hides is seen so much higher than what is hidden
};

/// Between which heights (z, scene metres) the ground lies over a rectangle of the plane (x and y,
/// metres); nothing where it does not cover all of it. More than there is does no harm.
using GroundRange = std::function<std::optional<HeightRange>(glm::dvec2 low, glm::dvec2 high)>;

/// The stretches of ground that a horizon looks at: begin so far from the eye, and end, metres; and
/// how fine they are.
struct HorizonReach {
    double first = 1.0;
    double last = 1.0;
    int sectors = 256;                ///< >= 8
    double growth = 1.0 + 1.0 / 16.0; ///< > 1, of the distance from each to the next
};

/// How high ground over a plane rises around an eye above it, from below: in each of some
/// sectors of azimuth, and for each of some distances, the steepest ray that is sure to have passed
/// through ground on the way (the lowest height of each stretch of a sector). A stretch is looked
/// at when it is first asked for, and never again.
class Horizon {
public:
    /// Precondition: the eye stands clear of the ground, above it (by more than view.near).
    Horizon(GroundRange ground, const HorizonReach& reach, const HorizonView& view);
    /// Of a heightfield, by its pyramid; absent where nothing can be said: the placement is bent,
    /// or the eye does not stand clear of the ground, above it. All of them outlive the horizon.
    static std::optional<Horizon> create(const Heightfield& heightfield,
                                         const MinMaxPyramid& pyramid, const Placement& placement,
                                         const HorizonView& view);

    /// Whether every ray from the eye to a point in the box passes through ground before, by more
    /// than the margin. Never yes where one does not. Only ground that is nearer than the box is
    /// looked at.
    [[nodiscard]] bool hides(const Box& box);

private:
    double steepest_before(int sector, std::size_t stretch);
    [[nodiscard]] std::optional<double> slope_of(int sector, std::size_t stretch) const;

    GroundRange ground_;
    HorizonView view_;
    double sector_angle_ = 0.0;     // radians
    double rectangle_growth_ = 1.0; // a stretch's rectangle reaches at most so many times as far
    std::vector<double> radii_;     // metres; stretch i lies between radii i and i + 1
    // By sector, as far as asked for: the steepest slope that is hidden behind stretches 0 … i.
    std::vector<std::vector<double>> sectors_;
};

} // namespace reljef::terrain
