#pragma once

#include <memory>
#include <optional>
#include <variant>

#include "engine/core/result.h"
#include "engine/material/relief_material.h"
#include "engine/scene/graph/scene.h"
#include "engine/truth/draw.h"
#include "engine/truth/geometric_error.h"
#include "engine/truth/layered_plane.h"
#include "engine/truth/relief_plane.h"

namespace reljef::truth {

/// A level square around the origin, covered with copies of a relief material and lit by a sun.
struct DetailSquare {
    std::shared_ptr<const material::ReliefMaterial> set; ///< from completed()
    std::optional<material::LayerKind> layers;           ///< absent: solid below the heights
    double side = 1.0;                                   ///< of the square, metres; > 0
    int repeats = 1;                                     ///< tiles along the side; > 0
    double scale = 0.1;                                  ///< see ReliefOptions
    double offset = -1.0;
    scene::Light light;
};

/// The true picture of such a square, seen through it as through a window, in double precision.
/// Lit as by the driver (Blinn and Phong, the material's normal map) with an exact shadow ray from
/// each hit. Thread-safe.
class DetailPlane {
public:
    /// Fails as ReliefPlane::create and LayeredPlane::create.
    static Result<DetailPlane> create(DetailSquare square);

    /// Hits as from the driver: col and row in the tile, height in [0,1], depth. The background is
    /// black. Fails when stopped.
    [[nodiscard]] Result<Picture> draw(const scene::Camera& camera, glm::ivec2 size,
                                       const DrawOptions& options = {}) const;

    /// See geometric_errors(). A hit does not name the tile's copy: the copy nearest to the pixel
    /// gives the reprojection error, and the hit error takes the shorter way across the border. A
    /// hit on layers lies on the layer nearest to its height.
    [[nodiscard]] Result<GeometricErrors> errors(const scene::Camera& camera,
                                                 const HitBuffer& shown, const HitBuffer& truth,
                                                 unsigned threads = 0) const;

private:
    DetailPlane() = default;
    [[nodiscard]] std::optional<ReliefHit> first_hit(const Ray& ray, Interval range) const;
    [[nodiscard]] std::optional<ReliefHit> seen(const scene::Camera& camera, const Ray& ray) const;
    [[nodiscard]] glm::dvec3 normal_at(const ReliefHit& hit) const;
    [[nodiscard]] glm::vec3 color_at(const ReliefHit& hit, const Ray& ray) const;
    [[nodiscard]] bool sees_sun(const Ray& ray, double t) const;
    [[nodiscard]] Hit hit_of(const ReliefHit& hit) const;
    [[nodiscard]] double true_height(glm::dvec2 coordinate, double hit_height) const;
    [[nodiscard]] double reprojection(const scene::Camera& camera, glm::ivec2 size,
                                      glm::ivec2 pixel, const Hit& hit) const;

    DetailSquare square_;
    glm::dvec2 texels_{0.0};
    double width_ = 1.0;     // of a tile, metres
    glm::dvec3 center_{0.0}; // of the tile with texture coordinates 0 … 1
    std::variant<std::monostate, ReliefPlane, LayeredPlane> surface_;
    material::LayerMap layers_;
    material::LayerNormals layer_normals_;
};

} // namespace reljef::truth
