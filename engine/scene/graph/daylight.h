#pragma once

#include <glm/vec3.hpp>

#include "engine/scene/graph/scene.h"

namespace reljef::scene {

/// Turbidity of the air: extinction of clean air and haze over that of clean air, at 550 nm.
inline constexpr double min_turbidity = 1.0;
inline constexpr double max_turbidity = 10.0;
inline constexpr double default_turbidity = 1.4;

/// Linear colours of sun and sky, exposed for a picture.
struct Daylight {
    glm::vec3 sun{0.0F};     ///< Light::color
    glm::vec3 ambient{0.0F}; ///< Light::ambient
    Sky sky;                 ///< zenith, horizon, glow, curve and fading
};

/// The light of a sun at `altitude` degrees, [-90, 90], through an atmosphere of molecules,
/// aerosols and ozone over a sphere: single scattering (Nishita et al. 1993), and further
/// scattering as a uniform source. docs/daylight.md derives it, the exposure and the tone mapping.
Daylight daylight_at(double altitude, double turbidity);

} // namespace reljef::scene
