#include <chrono>
#include <memory>

#include <fmt/format.h>

#include "bench/baselines/baseline_entry.h"
#include "bench/baselines/embree/embree_surface.h"

namespace reljef::bench {
namespace {

Grid<glm::vec3> world_vertices(const BaselineView& view) {
    const Grid<float>& heights = view.scene.surface().heightfield().heights;
    const terrain::Placement& placement = view.scene.surface().placement();
    const glm::dmat4& world_from_local = view.scene.terrain->world_from_local();
    Grid<glm::vec3> vertices(heights.cols(), heights.rows());
    for (int row = 0; row < heights.rows(); ++row) {
        for (int col = 0; col < heights.cols(); ++col) {
            const glm::dvec3 local =
                placement.world_from_sample(glm::dvec3(col, row, heights(col, row)));
            vertices(col, row) = glm::vec3(world_from_local * glm::dvec4(local, 1.0));
        }
    }
    return vertices;
}

} // namespace

BaselineEntries embree_entries(const BaselineView& view) {
    const Grid<glm::vec3> vertices = world_vertices(view);
    std::vector<BaselineEntry> entries;
    for (const EmbreeGeometry geometry : {EmbreeGeometry::grid, EmbreeGeometry::quads}) {
        auto surface = EmbreeSurface::create(vertices.view(), geometry, view.threads);
        if (!surface) {
            return surface.error();
        }
        BaselineEntry entry;
        entry.row.work = BaselineWork::hits;
        entry.row.what = fmt::format("Embree, {}", to_string(geometry));
        entry.hits = [&view, surface = *surface]() -> Result<HitBuffer> {
            return surface.draw_hits(view.scene.view(), view.size);
        };
        entry.draw = [hits = entry.hits](BaselineRow&) -> Result<double> {
            const auto begin = std::chrono::steady_clock::now();
            static_cast<void>(hits());
            const std::chrono::duration<double, std::milli> took =
                std::chrono::steady_clock::now() - begin;
            return took.count();
        };
        entries.push_back(std::move(entry));
    }
    return entries;
}

} // namespace reljef::bench
