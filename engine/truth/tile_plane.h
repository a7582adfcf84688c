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

/// A tile of detail, its copies side by side over a level square around the origin, lit by a sun.
struct TileSquare {
    std::shared_ptr<const material::ReliefMaterial> set; ///< as completed() gave it
    /// Which solids its maps say; absent: all below its heights.
    std::optional<material::LayerKind> layers;
    double side = 1.0;  ///< of the square, metres; > 0
    int repeats = 1;    ///< tiles along the side; > 0
    double scale = 0.1; ///< as ReliefOptions have it, and offset too
    double offset = -1.0;
    scene::Light light;
};

/// What a technique should show of such a square: what is seen through it as through a window, in
/// double precision. Light is that of the driver (Blinn and Phong, the set's normal map) with an
/// exact shadow ray from each hit. Safe to ask from several threads.
class TilePlane {
public:
    /// Fails as ReliefPlane and LayeredPlane do.
    static Result<TilePlane> create(TileSquare square);

    /// Hits as the driver draws them: col and row of the tile, height in [0,1], depth; black where
    /// nothing is. Each pixel's colour is the linear mean of rays_per_side² rays. Fails when it is
    /// stopped.
    [[nodiscard]] Result<Picture> draw(const scene::Camera& camera, glm::ivec2 size,
                                       const DrawOptions& options = {}) const;

    /// The errors of a frame against the true hits, see geometric_errors(). A hit names a place of
    /// the tile, not which copy: the reprojection error is that of the copy that falls nearest to
    /// the pixel, the hit error is taken across the border where that is nearer. Of layers the
    /// place lies at the one that is nearest to the height the hit claims.
    [[nodiscard]] Result<GeometricErrors> errors(const scene::Camera& camera,
                                                 const HitBuffer& shown, const HitBuffer& truth,
                                                 unsigned threads = 0) const;

private:
    struct Place {
        glm::dvec2 coordinate{0.0};
        double height = 0.0;
        int layer = 0;
        double t = 0.0;
    };
    TilePlane() = default;
    [[nodiscard]] std::optional<Place> first_hit(const Ray& ray, Interval range) const;
    [[nodiscard]] std::optional<Place> seen(const scene::Camera& camera, const Ray& ray) const;
    [[nodiscard]] glm::dvec3 normal_at(const Place& place) const;
    [[nodiscard]] glm::vec3 color_at(const Place& place, const Ray& ray) const;
    [[nodiscard]] bool sees_sun(const Ray& ray, double t) const;
    [[nodiscard]] Hit hit_of(const Place& place) const;
    [[nodiscard]] double true_height(glm::dvec2 coordinate, double claimed) const;
    [[nodiscard]] double reprojection(const scene::Camera& camera, glm::ivec2 size,
                                      glm::ivec2 pixel, const Hit& hit) const;

    TileSquare square_;
    glm::dvec2 texels_{0.0};
    double width_ = 1.0;     // of a tile, metres
    glm::dvec3 middle_{0.0}; // of the tile with texture coordinates 0 … 1
    std::variant<std::monostate, ReliefPlane, LayeredPlane> surface_;
    material::LayerMap layers_;
    material::LayerNormals layer_normals_;
};

} // namespace reljef::truth
