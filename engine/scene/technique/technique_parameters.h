#pragma once

#include <compare>
#include <variant>

namespace reljef::scene {

/// The name of a technique, for tables and sets.
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
};

// One struct for each technique: its parameters with their defaults. technique_catalogue.h has
// their ranges, and their names on the command line.

/// Colour over the flat reference surface.
struct Texture {
    static constexpr TechniqueId id = TechniqueId::texture;
    friend auto operator<=>(const Texture&, const Texture&) = default;
};

/// The heightfield as triangles: all, fewer by distance, or as few as an error allows.
struct Polygons {
    static constexpr TechniqueId id = TechniqueId::polygons;
    int max_levels = 1; ///< by distance; 1: every sample is a vertex
    double error = 0.0; ///< bound in pixels, instead of levels; 0: by levels
    bool morph = false; ///< with an error: vertices move to their places step by step
    friend auto operator<=>(const Polygons&, const Polygons&) = default;
};

/// One look at the height shifts the place.
struct Parallax {
    static constexpr TechniqueId id = TechniqueId::parallax;
    double offset = -0.5; ///< minus the height of the reference plane, [-1, 0]
    friend auto operator<=>(const Parallax&, const Parallax&) = default;
};

/// Parallax by no more than the height.
struct ParallaxLimited {
    static constexpr TechniqueId id = TechniqueId::parallax_limited;
    double offset = -0.5; ///< as of Parallax
    friend auto operator<=>(const ParallaxLimited&, const ParallaxLimited&) = default;
};

/// Parallax again from where the last look led.
struct ParallaxIterated {
    static constexpr TechniqueId id = TechniqueId::parallax_iterated;
    double offset = -0.5; ///< as of Parallax
    int iterations = 3;
    friend auto operator<=>(const ParallaxIterated&, const ParallaxIterated&) = default;
};

/// Equal steps along the ray.
struct Steep {
    static constexpr TechniqueId id = TechniqueId::steep;
    int linear_steps = 32;
    friend auto operator<=>(const Steep&, const Steep&) = default;
};

/// Equal steps, then bisection.
struct Relief {
    static constexpr TechniqueId id = TechniqueId::relief;
    int linear_steps = 11;
    int bisection_steps = 8;
    friend auto operator<=>(const Relief&, const Relief&) = default;
};

/// Equal steps, then chords.
struct Interval {
    static constexpr TechniqueId id = TechniqueId::interval;
    int linear_steps = 14;
    int secant_steps = 2;
    friend auto operator<=>(const Interval&, const Interval&) = default;
};

/// Steps by the angle of view, then one chord.
struct Pom {
    static constexpr TechniqueId id = TechniqueId::pom;
    int min_steps = 8;  ///< seen from straight above
    int max_steps = 32; ///< seen along the ground
    friend auto operator<=>(const Pom&, const Pom&) = default;
};

/// From empty cone to empty cone.
struct Cone {
    static constexpr TechniqueId id = TechniqueId::cone;
    bool relaxed = true; ///< cones that a ray may meet the surface in once
    int max_steps = 32;
    int bisection_steps = 2; ///< before the chord
    double min_step = 1.5;   ///< samples; 0: passes over nothing
    friend auto operator<=>(const Cone&, const Cone&) = default;
};

/// The true first hit.
struct Exact {
    static constexpr TechniqueId id = TechniqueId::exact;
    friend auto operator<=>(const Exact&, const Exact&) = default;
};

/// The vertices of a mesh cut fine, moved by the height.
struct Displacement {
    static constexpr TechniqueId id = TechniqueId::displacement;
    double max_texels = 4.0; ///< of the heights between two vertices
    friend auto operator<=>(const Displacement&, const Displacement&) = default;
};

/// Lit by the height's derivatives.
struct Bump {
    static constexpr TechniqueId id = TechniqueId::bump;
    friend auto operator<=>(const Bump&, const Bump&) = default;
};

/// Lit by the difference of two heights.
struct Emboss {
    static constexpr TechniqueId id = TechniqueId::emboss;
    double delta = 1.5; ///< texels between the two, towards the light
    friend auto operator<=>(const Emboss&, const Emboss&) = default;
};

/// Lit by a normal map.
struct Normal {
    static constexpr TechniqueId id = TechniqueId::normal;
    friend auto operator<=>(const Normal&, const Normal&) = default;
};

/// The surface warped onto the reference plane beforehand.
struct Prewarp {
    static constexpr TechniqueId id = TechniqueId::prewarp;
    friend auto operator<=>(const Prewarp&, const Prewarp&) = default;
};

/// A sheet with holes.
struct Lattice {
    static constexpr TechniqueId id = TechniqueId::lattice;
    int linear_steps = 32;
    int bisection_steps = 6; ///< before the chord
    friend auto operator<=>(const Lattice&, const Lattice&) = default;
};

/// A sheet with another back.
struct DualLayer {
    static constexpr TechniqueId id = TechniqueId::dual_layer;
    int linear_steps = 32;
    int bisection_steps = 6; ///< before the chord
    friend auto operator<=>(const DualLayer&, const DualLayer&) = default;
};

/// Two solids, one over the other.
struct MultiLayer {
    static constexpr TechniqueId id = TechniqueId::multi_layer;
    int linear_steps = 32;
    int bisection_steps = 6; ///< before the chord
    friend auto operator<=>(const MultiLayer&, const MultiLayer&) = default;
};

/// Which technique, and its parameters.
using TechniqueParameters =
    std::variant<Texture, Polygons, Parallax, ParallaxLimited, ParallaxIterated, Steep, Relief,
                 Interval, Pom, Cone, Exact, Displacement, Bump, Emboss, Normal, Prewarp, Lattice,
                 DualLayer, MultiLayer>;

} // namespace reljef::scene
