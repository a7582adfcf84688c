#include "engine/truth/draw.h"

#include <limits>

#include <glm/geometric.hpp>

namespace reljef::truth {
namespace {

Error stopped() {
    return {"the exact picture: drawing was stopped"};
}

// The rays of one picture. Depth along the view axis is their t.
class Eye {
public:
    Eye(const SceneCaster& caster, const scene::Camera& camera, glm::ivec2 size)
        : caster_(caster), camera_(scene::with_fitted_depth(camera, caster.bounds())), size_(size),
          range_(is_perspective() ? Interval{camera_.near, std::numeric_limits<double>::infinity()}
                                  : Interval{camera_.orthographic_near, camera_.orthographic_far}) {
    }

    [[nodiscard]] Ray ray(glm::dvec2 pixel) const { return scene::view_ray(camera_, size_, pixel); }

    [[nodiscard]] std::optional<SceneHit> first_hit(const Ray& ray) const {
        return caster_.first_hit(ray, range_);
    }

    [[nodiscard]] glm::vec3 color(const Ray& ray, const std::optional<SceneHit>& hit,
                                  const Shading& shading) const {
        if (!hit) {
            return shading.background(ray.direction);
        }
        // A map is seen from no particular distance: no air.
        return is_perspective() ? shading.at(*hit, hit->surface.t * glm::length(ray.direction))
                                : shading.at(*hit);
    }

private:
    [[nodiscard]] bool is_perspective() const {
        return camera_.projection == scene::ProjectionKind::perspective;
    }

    const SceneCaster& caster_;
    scene::Camera camera_;
    glm::ivec2 size_;
    Interval range_;
};

Hit shown(const std::optional<SceneHit>& hit) {
    if (!hit) {
        return {};
    }
    const glm::vec3 sample(hit->surface.sample);
    return {sample.x, sample.y, sample.z, static_cast<float>(hit->surface.t)};
}

// The linear mean over n×n rays of a pixel.
glm::vec3 mean_color(const Eye& eye, const Shading& shading, glm::ivec2 pixel, int n) {
    glm::vec3 sum(0.0F);
    for (int i = 0; i < n * n; ++i) {
        const glm::dvec2 part = (glm::dvec2(i % n, i / n) + 0.5) / static_cast<double>(n);
        const Ray ray = eye.ray(glm::dvec2(pixel) + part);
        sum += eye.color(ray, eye.first_hit(ray), shading);
    }
    return sum / static_cast<float>(n * n);
}

} // namespace

Result<Picture> draw(const scene::Scene& scene, glm::ivec2 size, const DrawOptions& options) {
    const auto caster = SceneCaster::create(scene);
    if (!caster) {
        return caster.error();
    }
    return draw(*caster, Shading(scene, *caster, options.shadow), scene.camera(), size, options);
}

Result<Picture> draw(const SceneCaster& caster, const Shading& shading, const scene::Camera& camera,
                     glm::ivec2 size, const DrawOptions& options) {
    check(size.x >= 1 && size.y >= 1, "a picture of at least 1x1 pixels was expected");
    check(options.rays_per_side >= 1, "at least one ray a pixel was expected");
    Picture picture{HitBuffer(size.x, size.y), Image(size.x, size.y)};
    const Eye eye(caster, camera, size);
    const auto draw_row = [&](int row) {
        for (int col = 0; col < size.x; ++col) {
            const Ray ray = eye.ray(glm::dvec2(col, row) + 0.5);
            const auto hit = eye.first_hit(ray);
            const glm::vec3 color =
                options.rays_per_side == 1
                    ? eye.color(ray, hit, shading)
                    : mean_color(eye, shading, {col, row}, options.rays_per_side);
            picture.hits(col, row) = shown(hit);
            picture.image(col, row) = rgba8_from_linear(color);
        }
    };
    if (!parallel_for(size.y, draw_row, options.parallel)) {
        return stopped();
    }
    return picture;
}

Result<HitBuffer> draw_hits(const scene::Scene& scene, glm::ivec2 size,
                            const ParallelOptions& parallel) {
    const auto caster = SceneCaster::create(scene);
    if (!caster) {
        return caster.error();
    }
    return draw_hits(*caster, scene.camera(), size, parallel);
}

Result<HitBuffer> draw_hits(const SceneCaster& caster, const scene::Camera& camera, glm::ivec2 size,
                            const ParallelOptions& parallel) {
    check(size.x >= 1 && size.y >= 1, "a picture of at least 1x1 pixels was expected");
    HitBuffer hits(size.x, size.y);
    const Eye eye(caster, camera, size);
    const auto draw_row = [&](int row) {
        for (int col = 0; col < size.x; ++col) {
            hits(col, row) = shown(eye.first_hit(eye.ray(glm::dvec2(col, row) + 0.5)));
        }
    };
    if (!parallel_for(size.y, draw_row, parallel)) {
        return stopped();
    }
    return hits;
}

} // namespace reljef::truth
