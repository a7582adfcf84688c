// The techniques of detail textures on a square, compared with the exact picture of the texture.
#include <fmt/format.h>

#include "bench/runner/benchmark_scene.h"
#include "bench/runner/gallery_tiles.h"
#include "bench/stress/stress_stage.h"

namespace reljef::bench {
namespace {

Result<void> check_detail(StressRun& run, const SceneChoice& choice) {
    auto scene = BenchmarkScene::open(choice, run.options().suite, run.stop());
    if (!scene) {
        return scene.error();
    }
    for (const scene::TechniqueInfo& info : techniques_of(choice)) {
        Worst sky;
        Worst wrong;
        for (const scene::Pose pose :
             {scene::Pose::overview, scene::Pose::oblique, scene::Pose::grazing}) {
            scene->set_pose(pose);
            const auto measured =
                scene->measure_error(scene::make_technique(info.id), run.renderer(), run.stop());
            if (run.stopped()) {
                return {};
            }
            if (!measured) {
                return measured.error();
            }
            sky.add(static_cast<double>(measured->error.holes), to_string(pose));
            wrong.add(measured->error.wrong_percent, to_string(pose));
        }
        StressRow row{.stress = "detail texture",
                      .terrain = scene->name(),
                      .technique = std::string(info.name),
                      .figure = "pixels of sky over ground",
                      .value = sky.value(),
                      .at = sky.at()};
        if (covers_ground(scene::make_technique(info.id))) {
            row.limit = 0.0;
        }
        run.add(row);
        row.figure = "% of pixels wrong";
        row.value = wrong.value();
        row.limit =
            info.id == scene::TechniqueId::exact ? std::optional(max_wrong_percent) : std::nullopt;
        row.at = wrong.at();
        run.add(row);
    }
    run.renderer().forget_scene();
    return {};
}

} // namespace

Result<void> stress_details(StressRun& run) {
    auto scenes = gallery_scenes();
    scenes.resize(static_cast<std::size_t>(run.cases(1, static_cast<int>(scenes.size()))));
    for (const SceneChoice& choice : scenes) {
        if (auto done = check_detail(run, choice); !done) {
            return done;
        }
    }
    return {};
}

} // namespace reljef::bench
