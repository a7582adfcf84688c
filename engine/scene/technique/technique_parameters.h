#pragma once

#include <compare>
#include <variant>

namespace reljef::scene {

/// The techniques, in the order of TechniqueParameters.
enum class TechniqueId {
    texture,
    polygons,
    parallax,
    parallax_limited,
    parallax_iterated,
    steep,
    relief,
    interval,
    pom,
    cone,
    exact,
    displacement,
    bump,
    emboss,
    normal,
    prewarp,
    lattice,
    dual_layer,
    multi_layer,
    automatic,
};

// One struct per technique: its parameters with their defaults. technique_catalogue.cpp has their
// meanings, ranges and names on the command line.

template <TechniqueId> struct NoParameters {
    friend auto operator<=>(const NoParameters&, const NoParameters&) = default;
};
using Texture = NoParameters<TechniqueId::texture>;
using Exact = NoParameters<TechniqueId::exact>;
using Bump = NoParameters<TechniqueId::bump>;
using Normal = NoParameters<TechniqueId::normal>;
using Prewarp = NoParameters<TechniqueId::prewarp>;

struct Polygons {
    int max_levels = 1; ///< by distance; 1: every sample is a vertex
    double error = 0.0; ///< bound in pixels, instead of levels; 0: by levels
    bool morph = false; ///< with an error: vertices move to their places step by step
    friend auto operator<=>(const Polygons&, const Polygons&) = default;
};

template <TechniqueId> struct SingleParallax {
    double offset = -0.5; ///< minus the height of the reference plane, [-1, 0]
    friend auto operator<=>(const SingleParallax&, const SingleParallax&) = default;
};
using Parallax = SingleParallax<TechniqueId::parallax>;
using ParallaxLimited = SingleParallax<TechniqueId::parallax_limited>;

struct ParallaxIterated {
    double offset = -0.5; ///< minus the height of the reference plane, [-1, 0]
    int iterations = 3;
    friend auto operator<=>(const ParallaxIterated&, const ParallaxIterated&) = default;
};

struct Steep {
    int linear_steps = 32;
    friend auto operator<=>(const Steep&, const Steep&) = default;
};

struct Relief {
    int linear_steps = 11;
    int bisection_steps = 8;
    friend auto operator<=>(const Relief&, const Relief&) = default;
};

struct Interval {
    int linear_steps = 14;
    int secant_steps = 2;
    friend auto operator<=>(const Interval&, const Interval&) = default;
};

struct Pom {
    int min_steps = 8;  ///< seen from straight above
    int max_steps = 32; ///< seen along the ground
    friend auto operator<=>(const Pom&, const Pom&) = default;
};

struct Cone {
    bool relaxed = true; ///< relaxed cones: a ray inside one meets the surface at most once
    int max_steps = 32;
    int bisection_steps = 2; ///< before the secant step
    double min_step = 1.5;   ///< samples; 0: a step never jumps over anything
    friend auto operator<=>(const Cone&, const Cone&) = default;
};

struct Displacement {
    double max_texels = 4.0; ///< texels of the heights between two vertices
    friend auto operator<=>(const Displacement&, const Displacement&) = default;
};

struct Emboss {
    double delta = 1.5; ///< texels between the two heights, towards the light
    friend auto operator<=>(const Emboss&, const Emboss&) = default;
};

template <TechniqueId> struct LayerSearch {
    int linear_steps = 32;
    int bisection_steps = 6; ///< before the secant step
    friend auto operator<=>(const LayerSearch&, const LayerSearch&) = default;
};
using Lattice = LayerSearch<TechniqueId::lattice>;
using DualLayer = LayerSearch<TechniqueId::dual_layer>;
using MultiLayer = LayerSearch<TechniqueId::multi_layer>;

/// In each view the cheapest of what keeps the bound (view/choice).
struct Automatic {
    double error = 1.0;   ///< bound in pixels
    bool typical = false; ///< also what keeps it for most pixels only
    friend auto operator<=>(const Automatic&, const Automatic&) = default;
};

/// A technique and its parameters, in the order of TechniqueId.
using TechniqueParameters =
    std::variant<Texture, Polygons, Parallax, ParallaxLimited, ParallaxIterated, Steep, Relief,
                 Interval, Pom, Cone, Exact, Displacement, Bump, Emboss, Normal, Prewarp, Lattice,
                 DualLayer, MultiLayer, Automatic>;

} // namespace reljef::scene
