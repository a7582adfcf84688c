#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.h"
#include "engine/scene/technique/technique_options.h"

namespace reljef::scene {

/// The range of an error that polygons can promise, pixels: a rasterizer's own takes most of less.
inline constexpr double least_polygons_error = 0.02;
inline constexpr double most_polygons_error = 16.0;

/// How a terrain's surface is drawn.
enum class TechniqueId {
    texture,           ///< colour over the flat reference surface
    polygons,          ///< the heightfield as triangles, all or as many as it takes
    parallax,          ///< one look at the height shifts the place
    parallax_limited,  ///< the same, by no more than the height
    parallax_iterated, ///< looked at again from where it was shifted to
    steep,             ///< equal steps along the ray
    relief,            ///< equal steps, then halving
    interval,          ///< equal steps, then the chord
    pom,               ///< steps by the angle of view, then one chord
    cone,              ///< from empty cone to empty cone
    exact,             ///< the true first hit
    displacement,      ///< the vertices of a mesh cut fine, moved by the height
    bump,              ///< lit by the height's derivatives
    emboss,            ///< lit by the difference of two heights
    normal,            ///< lit by a normal map
    prewarp,           ///< the surface warped onto the reference plane beforehand
    lattice,           ///< a sheet with holes
    dual_layer,        ///< a sheet with another back
    multi_layer,       ///< two solids, one over the other
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

struct TechniqueInfo {
    TechniqueId id;
    std::string_view name; ///< as on the command line
    std::string_view meaning;
    std::string_view source; ///< where it is described
    std::span<const ParameterInfo> parameters;
};

/// Every technique there is, in the order of the sources.
std::span<const TechniqueInfo> technique_catalogue();
const TechniqueInfo& technique_info(TechniqueId id);
/// Those that draw terrains.
std::vector<TechniqueInfo> terrain_techniques();

/// A technique with a value for each of its parameters, in the catalogue's order, and what else it
/// does.
struct Technique {
    TechniqueId id = TechniqueId::polygons;
    std::vector<double> values;
    TechniqueOptions options{};

    friend bool operator==(const Technique&, const Technique&) = default;
};

/// The value of one of its parameters. Precondition: it has one of that name.
double parameter(const Technique& technique, std::string_view name);
/// The same technique with another value. Preconditions: likewise, and the value is allowed.
Technique with_parameter(Technique technique, std::string_view name, double value);

/// Whether a mesh is seen from behind, too.
bool is_two_sided(const Technique& technique);

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
