#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <glm/mat3x3.hpp>
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

/// A rectangle of samples of a placement.
struct SampleRectangle {
    glm::dvec2 first{0.0}; ///< the least column and row
    glm::dvec2 last{0.0};
};

/// Bounds of the ground over a rectangle: scene metres above the plane or the ellipsoid, without
/// a geoid's height. Empty if the ground does not cover the rectangle. Bounds may be too wide.
using GroundRange = std::function<std::optional<HeightRange>(const SampleRectangle& samples)>;

/// The part of the ground that a horizon uses.
struct HorizonOptions {
    double first = 1.0;               ///< nearest distance, metres
    double last = 1.0;                ///< farthest distance, metres; at most 1000 km on the Earth
    int sectors = 256;                ///< of azimuth, >= 8
    double growth = 1.0 + 1.0 / 16.0; ///< ratio of consecutive distances, > 1, at most 9/8
    HeightRange heights = {};         ///< of all ground that may hide or be hidden, as GroundRange
    /// Metres across a cell of ground that may hide: its triangles are that far below its surface
    /// as the Earth curves in it.
    double cell = 0.0;
    /// The last column and row of the placement's samples.
    glm::dvec2 last_sample{0.0};
};

/// An eye's vertical, and how the ground lies around it: on a plane, or outside of a ball that
/// touches the ellipsoid from within below the eye.
class EyeFrame {
public:
    /// Empty where the placement has no samples.
    static std::optional<EyeFrame> create(const Placement& placement, glm::dvec3 eye);

    /// Height of the eye, as GroundRange but with a geoid's height.
    [[nodiscard]] double height() const { return height_; }
    [[nodiscard]] bool is_on_plane() const { return radius_ == 0.0; }
    /// How far along the ground lines are nearly straight in samples, metres.
    [[nodiscard]] double max_reach() const;
    /// From the eye, along its east, north and vertical.
    [[nodiscard]] glm::dvec3 seen(glm::dvec3 local) const { return axes_ * (local - eye_); }
    /// Metres along the ground to a place that is seen so far from the eye's vertical, and so far
    /// above the eye.
    [[nodiscard]] double along(double aside, double above) const;
    /// Height over distance, as seen from the eye, of a place at a distance along the ground.
    [[nodiscard]] double slope_of(double along, double height) const;
    /// The sample at a distance along the ground in a direction (east, north) of length 1; empty
    /// where there is none.
    [[nodiscard]] std::optional<glm::dvec2> sample_at(glm::dvec2 direction, double along) const;
    /// On a plane whose map is affine: samples from the eye's own per metre in a direction.
    [[nodiscard]] std::optional<glm::dvec2> samples_a_metre(glm::dvec2 direction) const;
    /// The most that samples of places up to this far above or below the ground move, in metres.
    [[nodiscard]] double drift(double along, double height) const;
    /// Samples within a horizontal distance of the eye.
    [[nodiscard]] std::optional<SampleRectangle> samples_around(double distance) const;

private:
    explicit EyeFrame(const Placement& placement) : placement_(placement) {}

    Placement placement_;
    glm::dvec3 eye_{0.0};
    glm::dmat3 axes_{1.0};  // eye's axes from local ones
    double latitude_ = 0.0; // degrees
    double height_ = 0.0;
    double radius_ = 0.0; // of the ball, metres; 0: a plane
};

/// Conservative occlusion by ground, seen from an eye above it. For each sector of azimuth and each
/// distance it holds the steepest slope that is certainly hidden, from the lowest height of each
/// stretch. Stretches are evaluated on demand.
class Horizon {
public:
    /// Empty if the eye is not more than view.near above the ground `below` it, and near poles.
    static std::optional<Horizon> create(const Placement& placement, GroundRange ground,
                                         const HeightRange& below, const HorizonOptions& reach,
                                         const HorizonView& view);
    /// The same of a heightfield in memory. The pyramid outlives the horizon.
    static std::optional<Horizon> create(const Heightfield& heightfield,
                                         const MinMaxPyramid& pyramid, const Placement& placement,
                                         const HorizonView& view);

    /// Whether ground that is nearer than the box hides all of it by the margin. Conservative:
    /// false in doubt.
    [[nodiscard]] bool hides(const Box& box);

private:
    Horizon(EyeFrame frame, GroundRange ground, const HorizonOptions& reach,
            const HorizonView& view, HeightRange zero);

    bool is_hidden(int sector, std::size_t stretch, double slope);
    [[nodiscard]] bool leaves_terrain(int sector, std::size_t stretch) const;
    [[nodiscard]] std::optional<double> slope_of(int sector, std::size_t stretch) const;
    [[nodiscard]] std::optional<SampleRectangle> samples_of(int sector, std::size_t stretch) const;
    [[nodiscard]] std::optional<glm::dvec2> sample_at(std::size_t border, double along) const;

    // Between two sectors.
    struct Border {
        glm::dvec2 direction{0.0};
        std::optional<glm::dvec2> samples_a_metre; // as EyeFrame
    };
    EyeFrame frame_;
    GroundRange ground_;
    HorizonView view_;
    double lowest_zero_; // metres: of a geoid
    double sagitta_;     // metres by which triangles are below the ground
    glm::dvec2 last_sample_;
    double heights_apart_;          // metres: the most between a ray and the eye's or the ground's
    double sector_angle_ = 0.0;     // radians
    double outside_ = 1.0;          // where tangents meet a sector's sides, over their radius
    double rectangle_growth_ = 1.0; // reach of a stretch's bounding rectangle over its radius
    std::vector<Border> borders_;   // of the sectors, one more than these
    std::optional<glm::dvec2> eye_sample_;
    std::vector<double> radii_; // metres; stretch i lies between radii i and i + 1
    // By sector, as far as evaluated: the steepest slope that is hidden behind stretches 0 … i.
    std::vector<std::vector<double>> sectors_;
    std::vector<bool> has_ended_; // by sector: the terrain ends, what is farther hides nothing
};

} // namespace reljef::terrain
