#pragma once

#include <string>
#include <string_view>

#include "engine/core/result.h"
#include "engine/scene/technique/technique_catalogue.h"
#include "engine/scene/technique/technique_options.h"
#include "engine/scene/technique/technique_parameters.h"

namespace reljef::scene {

/// How a surface is drawn: by which technique with which parameters, and what else it does.
struct Technique {
    TechniqueParameters parameters = Polygons{};
    TechniqueOptions options{};

    [[nodiscard]] TechniqueId id() const;

    friend bool operator==(const Technique&, const Technique&) = default;
};

/// What is drawn so that a technique's pixels are reached.
enum class Geometry {
    flat, ///< the flat reference surface
    full, ///< triangles over its samples
    box,  ///< the box that holds the surface; each pixel looks for it along its ray
};
Geometry geometry_of(TechniqueId id);

/// Whether each pixel searches for the surface along its ray.
bool looks_for_surface(TechniqueId id);

/// Whether it draws terrains.
bool draws_terrain(TechniqueId id);

/// Whether it draws any mesh with a tile of detail, not only a flat one: there `polygons` shows the
/// mesh as it is, as `texture` does.
bool draws_any_mesh(TechniqueId id);

/// Whether it looks for solids between layers, which are seen from either side.
bool looks_for_layers(TechniqueId id);

/// Whether it draws surfaces over a plane only, none that is bent over the Earth.
bool needs_plane(TechniqueId id);

/// Whether a mesh is seen from behind, too.
bool is_two_sided(const Technique& technique);

/// The error in pixels that polygons keep to; 0: they keep to none, or another technique draws.
double error_bound(const Technique& technique);

/// The offset of the reference plane, which only the parallax techniques have; null of all others.
const double* parallax_offset(const TechniqueParameters& parameters);
double* parallax_offset(TechniqueParameters& parameters);

/// The technique with its default parameters and no options.
Technique make_technique(TechniqueId id);

/// From "ID" or "ID:key=value,key=value", parameters and options in any order; what has no '='
/// belongs to the option before it. Errors name what was found and what was expected; levels and
/// an error contradict each other.
Result<Technique> parse_technique(std::string_view text);

/// "ID:key=value,…" with every parameter, but tacit ones that are as by default and, where
/// polygons has an error, its levels; and those options it has: parse_technique gives the same
/// technique back.
std::string to_string(const Technique& technique);

} // namespace reljef::scene
