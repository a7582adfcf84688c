#include "bench/baselines/baseline_entry.h"
#include "bench/baselines/povray_scene.h"

namespace reljef::bench {
namespace {

constexpr int povray_rounds = 3; // each picture is a process, which takes seconds

} // namespace

BaselineEntries povray_entries(const BaselineView& view) {
    const auto scene = PovrayScene::create(view);
    if (!scene) {
        return scene.error();
    }
    BaselineEntry entry;
    entry.row.work = BaselineWork::picture;
    entry.row.what = "POV-Ray, height_field";
    entry.max_rounds = povray_rounds;
    entry.draw = [&view, scene = *scene](BaselineRow&) { return scene.draw_picture(view); };
    entry.hits = [&view, scene = *scene]() -> Result<HitBuffer> {
        const auto depths = scene.draw_depths(view);
        return depths ? Result<HitBuffer>(hits_from_depths(view, *depths)) : depths.error();
    };
    std::vector<BaselineEntry> entries;
    entries.push_back(std::move(entry));
    return entries;
}

} // namespace reljef::bench
