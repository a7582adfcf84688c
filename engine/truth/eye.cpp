#include "engine/truth/eye.h"

#include <limits>

#include <glm/geometric.hpp>

namespace reljef::truth {

Eye::Eye(const scene::Camera& camera, glm::ivec2 size, const Box& bounds)
    : camera_(scene::with_fitted_depth(camera, bounds)), size_(size),
      range_(is_perspective() ? Interval{camera_.near, std::numeric_limits<double>::infinity()}
                              : Interval{camera_.orthographic_near, camera_.orthographic_far}) {}

double Eye::distance(const Ray& ray, double t) const {
    return is_perspective() ? t * glm::length(ray.direction) : 0.0;
}

Ray transformed(const glm::dmat4& matrix, const Ray& ray) {
    return {glm::dvec3(matrix * glm::dvec4(ray.origin, 1.0)),
            glm::dvec3(matrix * glm::dvec4(ray.direction, 0.0))};
}

Hit as_shown(const std::optional<terrain::SurfaceHit>& hit) {
    if (!hit) {
        return {};
    }
    return hit_at(glm::dvec2(hit->sample), hit->sample.z, hit->t);
}

glm::dvec2 place_in_pixel(glm::ivec2 pixel, int n, int index) {
    return glm::dvec2(pixel) + (glm::dvec2(index % n, index / n) + 0.5) / static_cast<double>(n);
}

} // namespace reljef::truth
