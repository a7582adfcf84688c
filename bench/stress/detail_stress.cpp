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

// Pixels of a square with bricks of any height that are not finite.
Result<void> check_detail_scale(StressRun& run, const truth::DetailSquare& square, double scale) {
    scene::Scene scene;
    scene::Material material;
    material.detail = {.set = square.set,
                       .repeats = glm::vec2(static_cast<float>(square.repeats)),
                       .scale = static_cast<float>(scale)};
    scene::Node& node =
        scene.add_mesh(scene::plane_mesh(glm::vec2(static_cast<float>(square.side))), material);
    scene.add_light(square.light);
    scene.add_camera({.eye = {0.0, -square.side, 0.4 * square.side}});
    Worst worst;
    for (const scene::TechniqueInfo& info : techniques_of({.terrain = {}, .detail = "brick"})) {
        node.get<scene::MeshNode>()->material.technique = scene::make_technique(info.id);
        const auto hits = run.renderer().draw_hits(scene);
        if (!hits) {
            return hits.error();
        }
        worst.add(static_cast<double>(count_not_finite(*hits)), info.name);
    }
    run.add({.stress = "detail texture",
             .terrain = fmt::format("brick, scale {:g}", scale),
             .figure = "pixels not finite",
             .value = worst.value(),
             .limit = 0.0,
             .at = worst.at()});
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
    const auto square = detail_square("brick", static_cast<unsigned>(run.options().suite.threads));
    if (!square) {
        return square.error();
    }
    for (const double scale : {1e-6, 1e-3, 1e3, 1e6}) {
        if (auto done = check_detail_scale(run, *square, scale); !done || run.stopped()) {
            return done;
        }
    }
    return {};
}

} // namespace reljef::bench
