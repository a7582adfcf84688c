#pragma once

#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/building/footprint.h"
#include "engine/building/roof.h"

namespace reljef::building {

/// A flat face, convex, or star-shaped around the mean of its corners.
struct Face {
    std::vector<glm::dvec3> corners; ///< metres, z up; counter-clockwise from outside
    /// Of each corner of a wall with windows: windows to the right, and down from the eaves. Other
    /// faces have none.
    std::vector<glm::dvec2> facade = {};
};

/// The heights of walls, metres.
struct Extent {
    double foot = 0.0; ///< may lie in the ground
    double ground = 0.0;
    double eaves = 0.0; ///< above the ground
};

/// One window of a façade; whole numbers of them fill each wall.
inline constexpr double window_bay = 3.2;    ///< metres along the wall
inline constexpr double window_storey = 3.0; ///< metres

/// Walls and a level roof.
std::vector<Face> flat_building(const Footprint& footprint, const Extent& extent);

/// Walls below the outline edges of a roof, and its parts. `outline`: as of the roof.
std::vector<Face> building_below(const std::vector<RoofPart>& roof, const Ring& outline,
                                 const Extent& extent);

/// Walls and a roof of this kind, whose highest point is `height` metres above the ground at z = 0;
/// the walls begin at `foot`. A hipped roof has equal slopes of hip_slope, or less where it would
/// be higher than half of the building. Only convex outlines without holes have one that are wide
/// enough for it, a few centimetres; others are flat.
std::vector<Face> building_of(const Footprint& footprint, RoofKind roof, double foot,
                              double height);
/// Whether it has a hipped roof then.
bool has_hips(const Footprint& footprint, RoofKind roof);
inline constexpr double hip_slope = 0.7; ///< rise over run, 35 degrees

/// The sides and the top of an upright box.
std::vector<Face> box_faces(const Ring& outline, double foot, double top);

/// A building or a part of one.
struct PaintedFaces {
    std::vector<Face> faces;
    glm::dvec3 origin{0.0}; ///< added to the corners
    glm::vec3 color{0.5F};  ///< linear albedo of all but the walls with façades
};

} // namespace reljef::building
