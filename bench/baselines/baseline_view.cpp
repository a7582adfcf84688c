#include "bench/baselines/baseline_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace reljef::bench {

DepthRange depth_range_of(const HitBuffer& hits) {
    DepthRange range{std::numeric_limits<double>::infinity(), 0.0};
    for (const Hit& hit : hits.samples()) {
        if (truth::shows_terrain(hit)) {
            range.near = std::min<double>(range.near, hit.depth);
            range.far = std::max<double>(range.far, hit.depth);
        }
    }
    return {0.5 * range.near, 2.0 * range.far};
}

truth::SurfaceView BaselineView::surface() const {
    return {scene.surface().heightfield().heights.view(), scene.surface().placement(),
            scene.terrain->world_from_local(), scene.view()};
}

void BaselineView::set_technique(const scene::Technique& technique) {
    scene.terrain->get<scene::TerrainNode>()->material.technique = technique;
}

HitBuffer hits_from_depths(const BaselineView& view, std::span<const double> depths) {
    HitBuffer hits(view.size.x, view.size.y);
    auto depth = depths.begin();
    for (int y = 0; y < view.size.y; ++y) {
        for (int x = 0; x < view.size.x; ++x, ++depth) {
            if (!std::isfinite(*depth)) {
                continue;
            }
            const Ray ray = scene::view_ray(view.scene.view(), view.size, glm::dvec2(x, y) + 0.5);
            if (const auto sample =
                    view.scene.surface().placement().sample_from_world(ray.at(*depth))) {
                hits(x, y) = {static_cast<float>(sample->x), static_cast<float>(sample->y),
                              static_cast<float>(sample->z), static_cast<float>(*depth)};
            }
        }
    }
    return hits;
}

} // namespace reljef::bench
