#include "bench/baselines/own_entries.h"

#include <chrono>

#include "engine/scene/technique/technique.h"

namespace reljef::bench {
namespace {

struct OwnRow {
    BaselineWork work;
    scene::Technique technique;
    bool is_reference = false;
    bool moving = false;
};

std::vector<OwnRow> own_rows() {
    using Work = BaselineWork;
    const scene::Technique fine{scene::Polygons{.error = 1.0}};
    const scene::Technique coarse{scene::Polygons{.error = 4.0}};
    const scene::Technique every_sample{scene::Polygons{}};
    const scene::Technique rays{scene::Exact{}};
    return {{Work::levels, fine, true},
            {Work::levels, coarse},
            {Work::levels, every_sample},
            {Work::levels, fine, true, true},
            {Work::levels, coarse, false, true},
            {Work::triangles, every_sample, true},
            {Work::relief, scene::Technique{scene::Parallax{}}, true},
            {Work::relief, scene::Technique{scene::ParallaxLimited{}}},
            {Work::hits, rays, true},
            {Work::picture, rays, true}};
}

Result<double> draw_own(session::SceneRenderer& renderer, const BaselineView& view,
                        BaselineRow& row) {
    const auto stats = renderer.draw(view.scene.scene, true);
    if (!stats) {
        return stats.error();
    }
    row.triangles = stats->triangles;
    return stats->cpu_ms + stats->gpu_ms;
}

Result<double> draw_own_hits(session::SceneRenderer& renderer, const BaselineView& view) {
    const auto begin = std::chrono::steady_clock::now();
    const auto hits = renderer.draw_hits(view.scene.scene);
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
    return hits ? Result<double>(took.count()) : hits.error();
}

BaselineEntry own_entry(const OwnRow& own, BaselineView& view, session::SceneRenderer& renderer) {
    BaselineEntry entry;
    entry.row.work = own.work;
    entry.row.what = scene::to_string(own.technique);
    entry.row.is_reference = own.is_reference;
    entry.row.moving = own.moving;
    entry.is_other = false;
    entry.set_camera = [&view, technique = own.technique] {
        view.set_technique(technique);
        return Result<void>();
    };
    entry.draw = [&view, &renderer, work = own.work](BaselineRow& row) {
        return work == BaselineWork::hits ? draw_own_hits(renderer, view)
                                          : draw_own(renderer, view, row);
    };
    entry.hits = [&view, &renderer] { return renderer.draw_hits(view.scene.scene); };
    return entry;
}

} // namespace

Result<OwnDevices> OwnDevices::create(const SuiteOptions& options) {
    session::DeviceOptions device{.context = options.context.value_or(session::BackendKind::glfw),
                                  .size = options.size,
                                  .shader_dir = options.shader_dir,
                                  .threads = options.threads};
    auto opengl = session::Device::create(device);
    if (!opengl) {
        return opengl.error();
    }
    device.context = session::BackendKind::cpu;
    auto rays = session::Device::create(device);
    if (!rays) {
        return rays.error();
    }
    OwnDevices made;
    made.opengl_.emplace(std::move(*opengl));
    made.rays_.emplace(std::move(*rays));
    return made;
}

std::vector<BaselineEntry> own_entries(BaselineView& view, OwnDevices& devices) {
    std::vector<BaselineEntry> entries;
    for (const OwnRow& own : own_rows()) {
        const bool by_rays = own.work == BaselineWork::hits || own.work == BaselineWork::picture;
        entries.push_back(own_entry(own, view, by_rays ? devices.rays() : devices.opengl()));
    }
    return entries;
}

} // namespace reljef::bench
