#include "engine/view/choice/view_probes.h"

#include <algorithm>
#include <limits>

#include <glm/common.hpp>

#include "engine/terrain/field/ray_cast.h"
#include "engine/terrain/field/surface_caster.h"
#include "engine/terrain/mesh/tile_layout.h"

namespace reljef::view {
namespace {

constexpr int stride_of_counts = 4; // samples, about
constexpr int probes_a_count = 3;   // of them, one is cast

// scene::view_ray() of all pixels of a picture, which is affine: three of them give the others.
class ViewRays {
public:
    ViewRays(const scene::Camera& camera, glm::ivec2 size)
        : size_(size), first_(scene::view_ray(camera, size, {0.0, 0.0})),
          right_(scene::view_ray(camera, size, {size.x, 0.0})),
          below_(scene::view_ray(camera, size, {0.0, size.y})) {}

    [[nodiscard]] Ray at(glm::dvec2 pixel) const {
        const glm::dvec2 part = pixel / size_;
        const auto blend = [part](glm::dvec3 first, glm::dvec3 right, glm::dvec3 below) {
            return first + part.x * (right - first) + part.y * (below - first);
        };
        return {blend(first_.origin, right_.origin, below_.origin),
                blend(first_.direction, right_.direction, below_.direction)};
    }

private:
    glm::dvec2 size_;
    Ray first_;
    Ray right_;
    Ray below_;
};

// Where rays in the terrain's metres hit it, in samples.
class ProbeCaster {
public:
    ProbeCaster(const scene::TerrainSurface& surface, const ProbedSurface* counted)
        : surface_(surface), counted_(counted) {}

    [[nodiscard]] std::optional<glm::dvec3> first_hit(const Ray& ray) {
        if (counted_ != nullptr) {
            if (const auto line = terrain::sample_ray_on_plane(surface_.placement(), ray)) {
                return counted_->first_hit(*line);
            }
        }
        if (!exact_) {
            exact_.emplace(surface_.heightfield().heights.view(), surface_.pyramid(),
                           surface_.placement());
        }
        const auto hit = exact_->first_hit(ray);
        return hit ? std::optional(hit->sample) : std::nullopt;
    }

private:
    const scene::TerrainSurface& surface_;
    const ProbedSurface* counted_;
    std::optional<terrain::SurfaceCaster> exact_;
};

// The probes through the box around the terrain, not cast.
std::vector<ProbeRay> probes_of_box(const DrawList& list, const TerrainDraw& draw) {
    const Box bounds = draw.terrain->surface->bounds();
    const glm::dvec3 offset(draw.world_from_local[3]);
    const ViewRays rays(list.camera, list.size);
    std::vector<ProbeRay> probes;
    probes.reserve(static_cast<std::size_t>(view_probes.x) * view_probes.y);
    for (int row = 0; row < view_probes.y; ++row) {
        for (int col = 0; col < view_probes.x; ++col) {
            const glm::ivec2 place(col, row);
            const glm::dvec2 pixel =
                (glm::dvec2(place) + 0.5) / glm::dvec2(view_probes) * glm::dvec2(list.size);
            Ray ray = rays.at(pixel);
            ray.origin -= offset;
            if (intersect(ray, bounds)) {
                probes.push_back({ray, pixel, std::nullopt, place});
            }
        }
    }
    return probes;
}

} // namespace

ProbedSurface::ProbedSurface(const scene::TerrainSurface& surface) {
    const Grid<float>& all = surface.heightfield().heights;
    const glm::ivec2 cells(all.cols() - 1, all.rows() - 1);
    const glm::ivec2 counted = glm::max(cells / stride_of_counts, glm::ivec2(1));
    scale_ = {glm::dvec2(cells) / glm::dvec2(counted), 1.0};
    heights_ = Grid<float>(counted.x + 1, counted.y + 1);
    for (int row = 0; row <= counted.y; ++row) {
        for (int col = 0; col <= counted.x; ++col) {
            const glm::ivec2 sample(glm::round(glm::dvec2(col, row) * glm::dvec2(scale_)));
            heights_(col, row) = all.clamped(sample.x, sample.y);
        }
    }
    pyramid_ = terrain::MinMaxPyramid(heights_.view());
}

std::optional<glm::dvec3> ProbedSurface::first_hit(const Ray& sample_ray) const {
    const auto hit = terrain::first_hit(heights_.view(), pyramid_,
                                        {sample_ray.origin / scale_, sample_ray.direction / scale_},
                                        {0.0, std::numeric_limits<double>::infinity()});
    return hit ? std::optional(hit->sample * scale_) : std::nullopt;
}

ProbedView probe_view(const DrawList& list, const TerrainDraw& draw, const ProbedSurface* counted) {
    const scene::TerrainSurface& surface = *draw.terrain->surface;
    const Grid<float>& heights = surface.heightfield().heights;
    const glm::ivec2 last_tile =
        (glm::ivec2(heights.cols(), heights.rows()) - 2) / terrain::tile_cells;
    const int step = counted != nullptr ? probes_a_count : 1;
    const double pixels_a_probe = step * static_cast<double>(list.size.x) * list.size.y /
                                  (static_cast<double>(view_probes.x) * view_probes.y);
    ProbeCaster caster(surface, counted);
    ProbedView probed{{}, probes_of_box(list, draw)};
    for (ProbeRay& probe : probed.of_box) {
        if ((probe.place.x + probe.place.y) % step != 0) {
            continue;
        }
        probe.hit = caster.first_hit(probe.ray);
        if (probe.hit) {
            const glm::ivec2 tile =
                glm::min(glm::ivec2(*probe.hit) / terrain::tile_cells, last_tile);
            probed.tile_pixels[{tile.x, tile.y}] += pixels_a_probe;
        }
    }
    return probed;
}

} // namespace reljef::view
