#pragma once

#include <optional>

#include <glm/vec2.hpp>

#include "engine/core/geometry.h"
#include "engine/core/hit.h"
#include "engine/scene/graph/scene.h"
#include "engine/terrain/field/ray_cast.h"

namespace reljef::truth {

/// The rays of one picture. Their t is the depth along the view axis.
class Eye {
public:
    /// `bounds`: of the scene. Orthographic rays begin in front of it.
    Eye(const scene::Camera& camera, glm::ivec2 size, const Box& bounds);

    [[nodiscard]] Ray ray(glm::dvec2 pixel) const { return scene::view_ray(camera_, size_, pixel); }
    [[nodiscard]] Interval range() const { return range_; }
    /// Metres of air in front of a hit; 0 on a map, which has no viewing distance.
    [[nodiscard]] double distance(const Ray& ray, double t) const;

    /// False on a map.
    [[nodiscard]] bool looks_through_air() const { return is_perspective(); }

    /// Sees the sky's picture, if it is one. `axes`: scene::ground_axes().
    void see(const std::optional<scene::Sky>& sky, const glm::dmat3& axes) {
        sky_ = sky ? scene::seen_sky(*sky, camera_, size_, axes) : std::nullopt;
    }
    /// Null: none.
    [[nodiscard]] const scene::SeenSky* sky() const { return sky_ ? &*sky_ : nullptr; }
    [[nodiscard]] glm::dvec3 place() const { return camera_.eye; }

private:
    [[nodiscard]] bool is_perspective() const {
        return camera_.projection == scene::ProjectionKind::perspective;
    }

    scene::Camera camera_;
    glm::ivec2 size_;
    Interval range_;
    std::optional<scene::SeenSky> sky_;
};

Ray transformed(const glm::dmat4& matrix, const Ray& ray);

/// As in a hit buffer.
Hit as_shown(const std::optional<terrain::SurfaceHit>& hit);

/// The places of the rays of a pixel, in pixels: a grid of n × n.
glm::dvec2 place_in_pixel(glm::ivec2 pixel, int n, int index);

} // namespace reljef::truth
