#pragma once

#include <optional>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/geometry.h"
#include "engine/scene/graph/camera.h"
#include "engine/scene/streaming/terrain_surface.h"
#include "engine/scene/technique/technique.h"

namespace reljef::view {

/// A ray through the middle of a few pixels of a picture, and what it shows.
struct ProbeRay {
    Ray ray;                       ///< local metres of the terrain, as scene::view_ray
    glm::dvec2 pixel{0.0};         ///< of the picture
    std::optional<glm::dvec3> hit; ///< col, row, height in metres; absent: the ray misses
    glm::ivec2 place{0};           ///< column and row among the probes
};

/// What a search found along probes.
struct SearchTrial {
    int terrain_probes = 0; ///< that show terrain, truly or by the search
    int within = 0;         ///< of these, as near to their true places as the bound asks
    double steps = 0.0;     ///< of each probe through the box around the terrain, mean

    /// Of the probes that show terrain, 0 to 1; 0 if none does.
    [[nodiscard]] double share() const {
        return terrain_probes > 0 ? static_cast<double>(within) / terrain_probes : 0.0;
    }
};

/// The searches that may skip thin features: `parallax`, `interval` and `relief`, from few steps to
/// many.
std::vector<scene::Technique> typical_searches();

/// These searches along rays over a terrain in memory on a plane, as OpenGL draws them, but in
/// doubles. `interval` begins where a block of pixels around the probe may meet the ground near its
/// hit, which is about where the beams of OpenGL end. They may end earlier, at other ground.
class TypicalSearch {
public:
    struct View {
        scene::Camera camera;
        glm::ivec2 size{0};     ///< of the picture, pixels
        glm::dvec3 offset{0.0}; ///< of the terrain, metres
    };
    /// Borrows the surface.
    TypicalSearch(const View& view, const scene::TerrainSurface& surface);

    /// The place (col, row) that a probe shows, and the steps that it takes.
    struct Found {
        std::optional<glm::dvec2> place;
        int steps = 0;
    };
    [[nodiscard]] Found find(const scene::Technique& technique, const ProbeRay& probe) const;

    /// Whether a place that a probe shows is at most `bound` pixels from it on the picture, and not
    /// hidden: the probe or a ray to the place hits the ground at most a sample away.
    [[nodiscard]] bool is_within(const ProbeRay& probe, glm::dvec2 place, double bound) const;

    /// What is asked of a search.
    struct Demand {
        double bound = 1.0; ///< pixels
        double share = 0.9; ///< of the probes that show terrain, within the bound
        int probes = 30;    ///< that show terrain: of fewer, a share says little
    };
    /// Empty if fewer are. Precondition: all probes meet the box around the terrain.
    [[nodiscard]] std::optional<SearchTrial> try_along(const scene::Technique& technique,
                                                       const std::vector<ProbeRay>& probes,
                                                       const Demand& demand) const;

private:
    struct RaySpan; // of a ray through the box around the terrain
    [[nodiscard]] std::optional<RaySpan> span_in_box(const Ray& ray) const;
    [[nodiscard]] RaySpan after_beam(const RaySpan& way, const ProbeRay& probe) const;
    [[nodiscard]] double height_at(glm::dvec2 place) const;
    [[nodiscard]] bool is_on_surface(glm::dvec2 place) const;
    [[nodiscard]] Found find_by(const scene::Parallax& parallax, const RaySpan& way) const;
    [[nodiscard]] Found find_by(const scene::Interval& interval, const RaySpan& way) const;
    [[nodiscard]] Found find_by(const scene::Relief& relief, const RaySpan& way) const;
    // Between `part` at clearance `over` (>= 0) and `low_part` at `under` (< 0).
    struct Crossing {
        double part = 0.0;
        double over = 0.0;
        double low_part = 1.0;
        double under = 0.0;
        int step = 0;
    };
    [[nodiscard]] double clearance(const RaySpan& way, double part) const;
    [[nodiscard]] std::optional<Crossing> first_crossing(const RaySpan& way, int steps) const;

    View view_;
    const scene::TerrainSurface& surface_;
    terrain::SurfaceCaster caster_;
    double lowest_ = 0.0; // metres
    double range_ = 1.0;  // metres
};

} // namespace reljef::view
