#pragma once

#include <optional>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/geometry.h"
#include "engine/terrain/heightfield.h"
#include "engine/terrain/min_max_pyramid.h"
#include "engine/terrain/placement.h"

namespace reljef::terrain {

/// Who looks over a terrain, metres of the placement's scene frame.
struct HorizonView {
    glm::dvec3 eye{0.0};
    double near = 0.0;   ///< no ray begins farther from the eye
    double margin = 0.0; ///< radians, >= 0: what hides is seen so much higher than what is hidden
};

/// How high a heightfield on a plane rises around an eye above it, from below: in each of some
/// sectors of azimuth, and for each of some distances, the steepest ray that is sure to have passed
/// through ground on the way (the lowest height of each stretch of a sector, from a pyramid of the
/// least heights). Sectors are made when they are first asked for.
class Horizon {
public:
    /// Absent where nothing can be said: the placement is bent, or the eye does not stand clear of
    /// the ground, above it. The pyramid is the heightfield's; both outlive the horizon.
    static std::optional<Horizon> create(const Heightfield& heightfield,
                                         const MinMaxPyramid& pyramid, const Placement& placement,
                                         const HorizonView& view);

    /// Whether every ray from the eye to a point in the box passes through ground before, by more
    /// than the margin. Never yes where one does not.
    [[nodiscard]] bool hides(const Box& box);

private:
    struct Stretch {
        glm::dvec2 low{0.0}; // metres
        glm::dvec2 high{0.0};
    };

    Horizon(const Heightfield& heightfield, const MinMaxPyramid& pyramid,
            const Placement& placement, const HorizonView& view);
    const std::vector<double>& sector(int index);
    [[nodiscard]] std::vector<double> make_sector(int index) const;
    [[nodiscard]] std::optional<double> lowest_in(const Stretch& stretch) const;

    const MinMaxPyramid* pyramid_;
    glm::dvec2 last_{0.0};    // sample
    glm::dvec2 spacing_{0.0}; // metres
    double exaggeration_ = 1.0;
    HorizonView view_;
    std::vector<double> radii_; // metres; stretch i lies between radii i and i + 1
    // By sector, empty until made: the steepest slope that is hidden behind stretches 0 … i.
    std::vector<std::vector<double>> sectors_;
};

} // namespace reljef::terrain
