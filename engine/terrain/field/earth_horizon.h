#pragma once

#include <optional>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/geometry.h"
#include "engine/terrain/field/horizon.h"
#include "engine/terrain/field/placement.h"

namespace reljef::terrain {

/// Conservative occlusion by the curved Earth: by an ellipsoid below all ground, which a terrain
/// covers as far as the eye sees it (Cozzi and Ring 2011, "3D Engine Design for Virtual Globes",
/// 12.4.3).
class EarthHorizon {
public:
    /// `samples`: of the placed terrain. `drawn`: the heights of all drawn ground, scene metres
    /// without a geoid's height. `cell`: samples between the vertices of the coarsest polygons.
    /// Empty on a plane, if the eye is not more than view.near above `drawn`, and if the terrain
    /// ends within the horizon.
    static std::optional<EarthHorizon> create(const Placement& placement, glm::ivec2 samples,
                                              HeightRange drawn, double cell,
                                              const HorizonView& view);

    /// Whether the ground hides all of the box by the view's margin. Conservative: false in doubt.
    [[nodiscard]] bool hides(const Box& box) const;

private:
    EarthHorizon() = default;

    // Lengths are those of the ellipsoid, which is a sphere of radius 1 then.
    glm::dmat3 scaled_from_scene_{1.0};
    glm::dvec3 origin_{0.0}; // of the scene
    glm::dvec3 eye_{0.0};
    glm::dvec3 down_{0.0};    // unit, from the eye to the Earth's centre
    double distance_ = 0.0;   // from the eye to the plane of the horizon
    double min_cosine_ = 1.0; // of the angle about `down_` within which the Earth is seen
};

} // namespace reljef::terrain
