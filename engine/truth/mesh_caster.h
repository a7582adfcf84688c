#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "engine/core/geometry.h"
#include "engine/core/hit.h"
#include "engine/core/result.h"
#include "engine/scene/graph/scene.h"

namespace reljef::truth {

struct MeshHit {
    double t = 0.0;           ///< along the world ray
    std::size_t mesh = 0;     ///< of the caster's
    std::size_t triangle = 0; ///< its first index
    glm::dvec2 shares{0.0};   ///< barycentric: of the second and third corner
};

/// Intersects rays with the triangles of a scene's meshes, in double precision, through a tree of
/// boxes for each mesh; instances of a mesh share it. Triangles are seen from outside only. Ignores
/// later changes of the scene. Thread-safe.
class MeshCaster {
public:
    /// The visible meshes; billboards face the scene's camera. Fails for one whose detail texture
    /// has relief.
    static Result<MeshCaster> create(const scene::Scene& scene);

    [[nodiscard]] bool empty() const { return instances_.empty(); }
    /// World metres.
    [[nodiscard]] const Box& bounds() const { return bounds_; }

    /// The nearest triangle with t in `range`. Of equal ones any.
    [[nodiscard]] std::optional<MeshHit> first_hit(const Ray& world_ray, Interval range) const;

    /// Whether a ray meets a triangle, from outside or from inside.
    [[nodiscard]] bool hides(const Ray& world_ray) const;

    /// Out of the hit's triangle: a unit vector in the world.
    [[nodiscard]] glm::dvec3 face_at(const MeshHit& hit) const;

    /// Linear: the colour, or the picture's bilinear one, times the light of the sun and the sky
    /// (shaders/frame/surface_light.glsl). `sees_sun`: nothing hides the sun.
    [[nodiscard]] glm::vec3 color_at(const MeshHit& hit, const std::optional<scene::Light>& sun,
                                     bool sees_sun = true) const;
    /// What it reflects of point lights. `place`: of the hit, world metres.
    [[nodiscard]] glm::vec3 from_points(const MeshHit& hit, glm::dvec3 place,
                                        std::span<const scene::PlacedPointLight> lights) const;

    /// As in a hit buffer: no place on the terrain, and the depth.
    [[nodiscard]] static Hit as_shown(const MeshHit& hit);

private:
    struct Tree; // of boxes around triangles
    struct Instance {
        std::shared_ptr<const Tree> tree;
        scene::MeshNode node;
        glm::dmat4 local_from_world{1.0};
        glm::dmat3 world_from_normal{1.0};
        Box bounds; // world metres
    };

    [[nodiscard]] glm::vec3 albedo_at(const MeshHit& hit) const;
    [[nodiscard]] glm::vec3 normal_at(const MeshHit& hit) const;

    std::vector<Instance> instances_;
    Box bounds_;
};

} // namespace reljef::truth
