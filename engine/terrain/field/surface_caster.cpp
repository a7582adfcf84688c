#include "engine/terrain/field/surface_caster.h"

#include <algorithm>
#include <cmath>

namespace reljef::terrain {
namespace {

// All in memory, as one tile.
class WholeSurface : public TiledSurface {
public:
    WholeSurface(const SurfaceTile& tile, const Placement& placement)
        : tile_(tile), placement_(placement) {}

    [[nodiscard]] glm::ivec2 last_sample() const override {
        return {tile_.heights.cols() - 1, tile_.heights.rows() - 1};
    }
    [[nodiscard]] int tile_cells() const override {
        return std::max(tile_.heights.cols(), tile_.heights.rows());
    }
    [[nodiscard]] const SurfaceTile* tile(glm::ivec2 /*at*/) const override { return &tile_; }
    [[nodiscard]] std::optional<MinMax> range(glm::ivec2 /*at*/) const override {
        return tile_.pyramid->total();
    }
    [[nodiscard]] std::optional<Ray> sample_ray(const Ray& world_ray) const override {
        return sample_ray_on_plane(placement_, world_ray);
    }
    [[nodiscard]] glm::dvec3 world_from_sample(glm::dvec3 sample) const override {
        return placement_.world_from_sample(sample);
    }
    [[nodiscard]] std::optional<glm::dvec3> sample_from_world(glm::dvec3 world) const override {
        return placement_.sample_from_world(world);
    }
    [[nodiscard]] std::optional<double> columns_all_around() const override {
        return placement_.columns_all_around();
    }

private:
    const SurfaceTile& tile_;
    const Placement& placement_;
};

} // namespace

Box shell_around(const TiledSurface& surface, MinMax heights) {
    float height = max_height_on_ellipsoid;
    while (height < std::max(heights.high, -heights.low)) {
        height *= 2.0F;
    }
    return reach(surface, {-height, height});
}

std::optional<Ray> sample_ray_on_plane(const Placement& placement, const Ray& world_ray) {
    if (placement.kind() != PlacementKind::plane) {
        return std::nullopt;
    }
    const glm::dvec3 way = world_ray.direction;
    if (const TileLattice* const lattice = placement.lattice()) {
        if (lattice->shorter_from() != lattice->cells || placement.columns_all_around()) {
            return std::nullopt;
        }
        const glm::dvec3 origin = *placement.sample_from_world(world_ray.origin);
        return Ray{origin, *placement.sample_from_world(world_ray.origin + way) - origin};
    }
    const glm::dvec2 spacing = placement.spacing();
    return Ray{*placement.sample_from_world(world_ray.origin),
               {way.x / spacing.x, -way.y / spacing.y, way.z / placement.exaggeration()}};
}

SurfaceCaster::SurfaceCaster(GridView<const float> heights, const MinMaxPyramid& pyramid,
                             const Placement& placement)
    : tile_{heights, &pyramid, {0, 0}}, placement_(placement),
      reach_(reach(WholeSurface(tile_, placement), pyramid.total())),
      shell_(shell_around(WholeSurface(tile_, placement), pyramid.total())) {}

std::optional<SurfaceHit> SurfaceCaster::first_hit(const Ray& world_ray, Interval range) const {
    if (!is_finite(world_ray)) {
        return std::nullopt;
    }
    const auto window = intersect(world_ray, reach_, range);
    const auto limits = intersect(world_ray, shell_, range);
    if (!window || !limits || !std::isfinite(limits->end)) {
        return std::nullopt;
    }
    const bool is_bent = !sample_ray_on_plane(placement_, world_ray);
    SurfaceRay ray(world_ray, {is_bent ? *limits : range, *window});
    ray.advance(WholeSurface(tile_, placement_));
    return ray.hit();
}

} // namespace reljef::terrain
