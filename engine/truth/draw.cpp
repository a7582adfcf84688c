#include "engine/truth/draw.h"

#include "engine/truth/eye.h"

namespace reljef::truth {
namespace {

// The nearest of both, or the sky.
struct Seen {
    std::optional<SceneHit> terrain;
    std::optional<MeshHit> mesh;
};

Seen seen_by(const SceneCaster& caster, const Ray& ray, Interval range) {
    Seen seen{caster.first_hit(ray, range), {}};
    if (seen.terrain) {
        range.end = seen.terrain->surface.t;
    }
    seen.mesh = caster.meshes().first_hit(ray, range);
    if (seen.mesh) {
        seen.terrain.reset();
    }
    return seen;
}

glm::vec3 color_of(const Eye& eye, const Ray& ray, const Seen& seen, const SceneCaster& caster,
                   const Shading& shading) {
    if (seen.mesh) {
        return shading.at(*seen.mesh, caster, ray, eye.distance(ray, seen.mesh->t));
    }
    return seen.terrain ? shading.at(*seen.terrain, ray, eye.distance(ray, seen.terrain->surface.t))
                        : shading.background(ray, eye);
}

Hit shown_hit(const Seen& seen) {
    if (seen.mesh) {
        return MeshCaster::as_shown(*seen.mesh);
    }
    return as_shown(seen.terrain ? std::optional(seen.terrain->surface) : std::nullopt);
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
    Eye eye(camera, size, caster.bounds());
    if (!caster.terrains().empty()) {
        const PlacedTerrain& first = caster.terrains().front();
        eye.see(shading.sky(), scene::ground_axes(first.surface->placement(),
                                                  first.world_from_local, eye.place()));
    } else {
        eye.see(shading.sky(), glm::dmat3(1.0));
    }
    const auto color_at = [&](glm::dvec2 place) {
        const Ray ray = eye.ray(place);
        return color_of(eye, ray, seen_by(caster, ray, eye.range()), caster, shading);
    };
    const auto done = for_each_pixel(size, options.parallel, [&](glm::ivec2 pixel) {
        const Ray ray = eye.ray(glm::dvec2(pixel) + 0.5);
        const Seen seen = seen_by(caster, ray, eye.range());
        const glm::vec3 color = options.rays_per_side == 1
                                    ? color_of(eye, ray, seen, caster, shading)
                                    : mean_color(pixel, options.rays_per_side, color_at);
        picture.hits(pixel.x, pixel.y) = shown_hit(seen);
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
    const Eye eye(camera, size, caster.bounds());
    const auto done = for_each_pixel(size, parallel, [&](glm::ivec2 pixel) {
        hits(pixel.x, pixel.y) =
            shown_hit(seen_by(caster, eye.ray(glm::dvec2(pixel) + 0.5), eye.range()));
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
        sum += color_at(place_in_pixel(pixel, n, i));
    }
    return sum / static_cast<float>(n * n);
}

} // namespace reljef::truth
