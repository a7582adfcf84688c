#pragma once

#include <array>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "engine/view/draw_list.h"

namespace reljef::view {

/// The fine structure (material::GrainMap) of near ground, as a view shows it. Patterns of
/// successive widths lie over each other, at places in the world, in the planes between two axes
/// that the ground faces. The axes are those of the world, turned about z by atan(turn.y / turn.x):
/// repetitions do not show along rows and columns of the data.
struct GrainView {
    static constexpr int max_patterns = 3;
    static constexpr double unseen_level = 6.0;  ///< of a pattern's mip levels: it has faded
    static constexpr glm::vec2 turn{0.8F, 0.6F}; ///< cosine and sine
    /// The widest pattern is bent by waves of 7 and 11 widths, so that its copies differ.
    static constexpr double copies = 77.0;

    float strength = 0.0F;          ///< scene::shown_grain()
    glm::vec3 up{0.0F, 0.0F, 1.0F}; ///< at the eye, unit vector along the turned axes
    glm::vec3 level_light{1.0F};    ///< that level ground of albedo 1 reflects, linear, above 0
    double radius = 0.0;            ///< from the eye to the Earth's middle, metres; 0: a plane
    int pattern_count = 0;
    /// The widest first. xyz: the eye's place in the pattern, in its widths, modulo 1, or of the
    /// widest modulo `copies`; w: widths in a metre.
    std::array<glm::vec4, max_patterns> patterns{};
    /// Metres along the turned axes per column, row (of the terrain's surface) and metre of height,
    /// near the eye.
    glm::dmat3 metres_per_sample{1.0};
};

/// Along the turned axes.
glm::dvec3 turned(glm::dvec3 world);

/// Whether ground that is at least `distance` metres away may show grain.
bool shows_grain(const DrawList& list, const scene::TerrainNode& terrain, double distance);

/// Precondition: the terrain is drawn by the list.
GrainView grain_view(const DrawList& list, const scene::TerrainNode& terrain,
                     const glm::dmat4& world_from_local);

} // namespace reljef::view
