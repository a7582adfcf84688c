#pragma once

#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/geometry.h"
#include "engine/scene/graph/ground_pick.h"
#include "engine/terrain/field/surface_caster.h"
#include "engine/view/draw_list.h"

namespace reljef::view {

/// The ground that a view shows of a terrain, by sample of the terrain's surface.
class LabelGround {
public:
    /// The list outlives this object.
    LabelGround(const DrawList& list, const TerrainDraw& draw);

    [[nodiscard]] glm::dvec2 last_sample() const { return last_; }
    [[nodiscard]] bool is_inside(glm::dvec2 sample) const;
    /// True metres; empty outside.
    [[nodiscard]] std::optional<double> height(glm::dvec2 sample) const;
    /// World metres. `height`: true metres.
    [[nodiscard]] glm::dvec3 place(glm::dvec2 sample, double height) const;
    [[nodiscard]] glm::dvec3 up(glm::dvec3 place) const; ///< unit vector in the world
    /// Whether a world ray meets the ground in a range of t.
    bool is_met(const Ray& ray, Interval range);

private:
    const scene::TerrainSurface& surface_;
    glm::dmat4 world_from_local_;
    glm::dmat4 local_from_world_;
    glm::dvec2 last_;
    terrain::SurfaceCaster caster_;
    std::optional<scene::GroundTiles> tiles_; // empty: the surface is the ground
};

} // namespace reljef::view
