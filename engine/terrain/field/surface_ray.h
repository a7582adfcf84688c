#pragma once

#include <array>
#include <limits>
#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/geometry.h"
#include "engine/terrain/field/ray_cast.h"
#include "engine/terrain/field/tiled_surface.h"

namespace reljef::terrain {

/// A place of a ray over a surface.
struct RayPlace {
    double t = 0.0;
    std::optional<glm::dvec3> sample; ///< empty outside the map's domain
};

/// Interpolates five points of a ray, evenly spaced in t (Newton's form). It is accurate over
/// 100 km and 100 times as fast as the map.
class Quartic {
public:
    explicit Quartic(const std::array<RayPlace, 5>& places);

    [[nodiscard]] RayPlace at(double t) const;
    /// Whether it interpolates this point, too.
    [[nodiscard]] bool meets(const RayPlace& place) const;

private:
    double begin_;
    double step_;
    std::array<glm::dvec3, 5> differences_; // divided, of order 0 to 4
};

/// The part of a ray that a search covers.
struct RayLimits {
    /// Decides where a bent ray is divided: equal for all searches that must agree.
    Interval range{0.0, std::numeric_limits<double>::infinity()};
    /// The ray meets no surface outside.
    Interval window{-std::numeric_limits<double>::infinity(),
                    std::numeric_limits<double>::infinity()};
};

/// A bounding box of a placed surface between two heights: 17² points of each, with a margin for
/// the Earth's curvature.
Box reach(const TiledSurface& surface, MinMax heights);

/// Searches the first crossing of a world ray from above to below a surface. Waits for tiles that
/// are not in memory. The hit does not depend on what is in memory meanwhile.
///
/// Where the mapping is not affine, the ray is bent in sample coordinates. Where it may touch the
/// surface it is halved until the middle of each piece lies within 0.001 samples and 0.001 m of its
/// chord. The hit then moves along the ray onto the surface. The piece with the seam of a
/// globe, where the last column is the first, is searched on both sides of it.
class SurfaceRay {
public:
    /// Precondition: a finite ray; finite limits if the mapping is not affine.
    SurfaceRay(const Ray& world_ray, const RayLimits& limits) : ray_(world_ray), limits_(limits) {}

    /// Continues with the tiles in memory. Precondition: always the same surface.
    void advance(const TiledSurface& surface);

    /// After advance(): the tile that the ray waits for.
    [[nodiscard]] const std::optional<glm::ivec2>& needed() const { return needed_; }
    /// Without a needed tile: the hit; empty if the ray meets nothing.
    [[nodiscard]] const std::optional<SurfaceHit>& hit() const { return hit_; }
    /// Everything before is done.
    [[nodiscard]] double t() const { return t_; }

private:
    struct Span {
        Quartic quartic;
        RayPlace from;
        RayPlace to;
        int halvings;
    };

    struct Chord {
        RayPlace from;
        RayPlace to;
        bool moves_hit; // onto the surface
    };

    [[nodiscard]] bool is_done() const { return hit_ || needed_; }
    [[nodiscard]] RayPlace place_at(double t) const;
    [[nodiscard]] bool is_outside(const RayPlace& from, const RayPlace& to) const;
    [[nodiscard]] bool is_new(const RayPlace& from) const;
    void search(const RayPlace& from, const RayPlace& halfway, const RayPlace& to, int halvings);
    void search_span(const RayPlace& from, const RayPlace& to, int halvings);
    bool clears_surface(const RayPlace& from, const RayPlace& halfway, const RayPlace& to);
    bool waits_at(const RayPlace& place);
    void search_chord(const RayPlace& from, const RayPlace& to, bool moves_hit);
    [[nodiscard]] bool crosses_seam(const RayPlace& from, const RayPlace& to) const;
    [[nodiscard]] bool passes_beside(const RayPlace& from, const RayPlace& to) const;
    void search_across_seam(const RayPlace& from, const RayPlace& to);
    void walk(const Ray& sample_ray, Interval range, const Chord* chord);
    bool passes(const TileWalk& walk, const Ray& sample_ray);
    SurfaceHit on_ray(const SurfaceHit& chord_hit, const Chord& chord);
    SurfaceHit moved_onto_surface(const SurfaceHit& hit, const Chord& chord);
    double slope_over_surface(const SurfaceHit& hit, const Chord& chord);
    double clearance(const RayPlace& place);

    const TiledSurface* surface_ = nullptr; // while it advances
    Ray ray_;
    RayLimits limits_;
    double t_ = -std::numeric_limits<double>::infinity();
    Side side_ = Side::unknown;      // at t_, or where the ray enters tile_
    std::optional<Span> span_;       // of t_
    std::optional<glm::ivec2> tile_; // of the piece that begins at t_: those before are done
    std::optional<glm::ivec2> needed_;
    std::optional<SurfaceHit> hit_;
};

} // namespace reljef::terrain
