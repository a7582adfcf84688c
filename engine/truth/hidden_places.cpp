#include "engine/truth/hidden_places.h"

#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

#include "engine/core/parallel_for.h"

namespace reljef::truth {
namespace {

bool is_hidden(const SurfaceView& view, const terrain::SurfaceCaster& caster, glm::ivec2 size,
               const Hit& hit) {
    const glm::dvec2 texel = hit.place();
    if (!std::isfinite(texel.x) || !std::isfinite(texel.y)) {
        return true;
    }
    const double height = terrain::bilinear_height(view.heights, texel);
    const glm::dvec3 local = view.placement.world_from_sample({texel, height});
    const scene::Projected seen = scene::project(
        view.camera, size, glm::dvec3(view.world_from_local * glm::dvec4(local, 1.0)));
    if (view.camera.projection == scene::ProjectionKind::perspective && !(seen.depth > 0.0)) {
        return true;
    }
    const glm::dmat4 local_from_world = glm::inverse(view.world_from_local);
    const Ray ray = scene::view_ray(view.camera, size, seen.pixel);
    const auto met = caster.first_hit({glm::dvec3(local_from_world * glm::dvec4(ray.origin, 1.0)),
                                       glm::dmat3(local_from_world) * ray.direction});
    return met && met->t < seen.depth &&
           glm::distance(glm::dvec2(met->sample), texel) > max_texels_off;
}

} // namespace

double ShownPlaces::hidden_percent() const {
    return shown == 0 ? 0.0 : 100.0 * static_cast<double>(hidden) / static_cast<double>(shown);
}

ShownPlaces hidden_places(const SurfaceView& view, const terrain::SurfaceCaster& caster,
                          const HitBuffer& shown, unsigned threads) {
    const glm::ivec2 size(shown.cols(), shown.rows());
    std::vector<ShownPlaces> rows(static_cast<std::size_t>(size.y));
    for_each_cell(size.x, size.y, {threads, {}, {}}, [&](int col, int row) {
        const Hit& hit = shown(col, row);
        if (shows_terrain(hit)) {
            ShownPlaces& places = rows[static_cast<std::size_t>(row)];
            ++places.shown;
            places.hidden += is_hidden(view, caster, size, hit) ? 1U : 0U;
        }
    });
    ShownPlaces all;
    for (const ShownPlaces& places : rows) {
        all.shown += places.shown;
        all.hidden += places.hidden;
    }
    return all;
}

} // namespace reljef::truth
