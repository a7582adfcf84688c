#pragma once

#include <string>
#include <string_view>

#include "engine/core/result.h"
#include "engine/scene/technique/technique_catalogue.h"
#include "engine/scene/technique/technique_options.h"
#include "engine/scene/technique/technique_parameters.h"

namespace reljef::scene {

/// How a surface is drawn: the technique with its parameters, and options.
struct Technique {
    TechniqueParameters parameters = Polygons{};
    TechniqueOptions options{};

    [[nodiscard]] TechniqueId id() const { return static_cast<TechniqueId>(parameters.index()); }

    friend bool operator==(const Technique&, const Technique&) = default;
};

/// The proxy geometry that a technique rasterizes.
enum class Geometry {
    flat, ///< the flat reference surface
    full, ///< triangles over the samples
    box,  ///< the box around the surface; each pixel searches for the surface along its ray
};
Geometry geometry_of(TechniqueId id);

/// Whether each pixel searches for the surface along its ray.
bool searches_surface(TechniqueId id);

/// Whether it draws a terrain as triangles over its heights.
bool draws_triangles(TechniqueId id);

bool draws_terrain(TechniqueId id);

/// Whether it draws any mesh with a detail tile, not only flat ones. `polygons` shows such a mesh
/// as `texture` does.
bool draws_any_mesh(TechniqueId id);

/// Whether it searches for solids between layers, which are visible from both sides.
bool searches_layers(TechniqueId id);

/// Whether it draws surfaces over a plane only, none on the ellipsoid.
bool needs_plane(TechniqueId id);
/// Whether a georeferenced terrain is put on a plane for it, unless the ellipsoid is requested or
/// the plane distorts it too much: its rays are straight there.
bool is_faster_on_plane(TechniqueId id);

/// Whether it shows the back of a mesh, too.
bool is_two_sided(const Technique& technique);

/// The error bound of polygons and auto, pixels; 0 without a bound, and for other techniques.
double error_bound(const Technique& technique);

/// The tiles of a stream are fine enough for this error of `exact`, pixels, if memory suffices. A
/// larger one is reported as one over an error bound is.
inline constexpr double max_expected_error_of_rays = 1.0;

/// The offset of the reference plane of the parallax techniques; null for others.
const double* parallax_offset(const TechniqueParameters& parameters);
double* parallax_offset(TechniqueParameters& parameters);

/// The technique with default parameters and no options.
Technique make_technique(TechniqueId id);

/// The technique with another value of one of its parameters. Parameters that exclude this one get
/// their defaults. Precondition: the parameter is the technique's and allows the value.
Technique with_parameter(Technique technique, const ParameterInfo& parameter, double value);

/// Parses "ID" or "ID:key=value,key=value": parameters and options in any order. A part without '='
/// belongs to the option before it. Errors name what was found and what was expected. Levels and an
/// error bound exclude each other.
Result<Technique> parse_technique(std::string_view text);

/// "ID:key=value,…" with the parameters and the options that are set; parse_technique() gives the
/// same technique back. Leaves out tacit parameters with their defaults, and the levels of polygons
/// with an error bound.
std::string to_string(const Technique& technique);

} // namespace reljef::scene
