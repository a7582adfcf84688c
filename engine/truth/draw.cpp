#include "engine/truth/draw.h"

#include <limits>

#include <glm/geometric.hpp>

namespace reljef::truth {
namespace {

// The rays of one picture. Their t is the depth along the view axis.
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
        // A map has no viewing distance, hence no air.
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
    const glm::dvec3 sample = hit->surface.sample;
    return hit_at(glm::dvec2(sample), sample.z, hit->surface.t);
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
    check(options.rays_per_side >= 1, "at least one ray a pixel was expected");
    Picture picture{HitBuffer(size.x, size.y), Image(size.x, size.y)};
    const Eye eye(caster, camera, size);
    const auto color_at = [&](glm::dvec2 place) {
        const Ray ray = eye.ray(place);
        return eye.color(ray, eye.first_hit(ray), shading);
    };
    const auto done = for_each_pixel(size, options.parallel, [&](glm::ivec2 pixel) {
        const Ray ray = eye.ray(glm::dvec2(pixel) + 0.5);
        const auto hit = eye.first_hit(ray);
        const glm::vec3 color = options.rays_per_side == 1
                                    ? eye.color(ray, hit, shading)
                                    : mean_color(pixel, options.rays_per_side, color_at);
        picture.hits(pixel.x, pixel.y) = shown(hit);
        picture.image(pixel.x, pixel.y) = rgba8_from_linear(color);
    });
    return done ? Result<Picture>(std::move(picture)) : done.error();
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
    HitBuffer hits(size.x, size.y);
    const Eye eye(caster, camera, size);
    const auto done = for_each_pixel(size, parallel, [&](glm::ivec2 pixel) {
        hits(pixel.x, pixel.y) = shown(eye.first_hit(eye.ray(glm::dvec2(pixel) + 0.5)));
    });
    return done ? Result<HitBuffer>(std::move(hits)) : done.error();
}

Result<void> for_each_pixel(glm::ivec2 size, const ParallelOptions& parallel,
                            const std::function<void(glm::ivec2 pixel)>& body) {
    check(size.x >= 1 && size.y >= 1, "a picture of at least 1x1 pixels was expected");
    const auto draw_row = [&](int row) {
        for (int col = 0; col < size.x; ++col) {
            body({col, row});
        }
    };
    if (!parallel_for(size.y, draw_row, parallel)) {
        return Error{"the exact picture: drawing was stopped"};
    }
    return {};
}

glm::vec3 mean_color(glm::ivec2 pixel, int n,
                     const std::function<glm::vec3(glm::dvec2 place)>& color_at) {
    glm::vec3 sum(0.0F);
    for (int i = 0; i < n * n; ++i) {
        const glm::dvec2 part = (glm::dvec2(i % n, i / n) + 0.5) / static_cast<double>(n);
        sum += color_at(glm::dvec2(pixel) + part);
    }
    return sum / static_cast<float>(n * n);
}

} // namespace reljef::truth
