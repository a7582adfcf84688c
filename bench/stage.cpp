#include "bench/stage.h"

#include <algorithm>

#include <fmt/format.h>

namespace reljef::bench {
namespace {

Result<app::TerrainSource> open_source(const StageChoice& choice, const app::TerrainChoice& terrain,
                                       const std::stop_token& stop) {
    if (choice.size == 0) {
        return app::open_terrain(terrain, stop);
    }
    io::SceneDescription description;
    description.name =
        fmt::format("{} {}{}", choice.terrain, choice.size, choice.tileable ? " tile" : "");
    description.generator = choice.terrain;
    description.size = choice.size;
    description.tileable = choice.tileable;
    return app::open_terrain(std::move(description), terrain, stop);
}

} // namespace

Result<Stage> Stage::open(const StageChoice& choice, const StageOptions& options,
                          const std::stop_token& stop) {
    app::TerrainChoice terrain;
    terrain.terrain = choice.terrain;
    terrain.threads = options.threads;
    terrain.quiet = options.quiet;
    terrain.placement = terrain::PlacementKind::plane; // one surface that all techniques draw
    auto source = open_source(choice, terrain, stop);
    if (!source) {
        return source.error();
    }
    app::ViewChoice view;
    view.size = options.size;
    view.pose = scene::Pose::overview;
    std::string name = source->description.name;
    auto scene = app::make_scene(std::move(*source), terrain, view);
    if (!scene) {
        return scene.error();
    }
    return Stage(std::move(name), std::move(*scene), options);
}

void Stage::set_pose(scene::Pose pose) {
    scene::Camera& camera = *scene_.camera->get<scene::Camera>();
    const double near = camera.near;
    camera = scene::pose_camera(pose, scene_.bounds,
                                [this](double x, double y) { return scene_.ground(x, y); });
    camera.near = near;
    pose_ = pose;
}

void Stage::set_camera(const scene::Camera& camera) {
    *scene_.camera->get<scene::Camera>() = camera;
}

void Stage::set_technique(const scene::Technique& technique) {
    scene_.terrain->get<scene::TerrainNode>()->material.technique = technique;
}

Result<std::reference_wrapper<const TruePicture>> Stage::truth(const std::stop_token& stop) {
    if (truth_ && truth_->pose == pose_) {
        return std::cref(*truth_);
    }
    if (!caster_) {
        auto caster = truth::SceneCaster::create(scene());
        if (!caster) {
            return caster.error();
        }
        caster_ = std::move(*caster);
        shading_.emplace(scene(), *caster_);
    }
    const ParallelOptions parallel{static_cast<unsigned>(options_.threads), stop, {}};
    auto picture =
        truth::draw(*caster_, *shading_, scene().camera(), options_.size, {.parallel = parallel});
    if (!picture) {
        return picture.error();
    }
    truth_ = TruePicture{pose_, std::move(picture->hits),
                         std::make_shared<const Image>(std::move(picture->image))};
    return std::cref(*truth_);
}

Result<Stage*> Stages::get(const StageChoice& choice) {
    const auto found = std::find_if(open_.begin(), open_.end(),
                                    [&](const auto& entry) { return entry.first == choice; });
    if (found != open_.end()) {
        return found->second.get();
    }
    if (!keep_) {
        open_.clear();
    }
    auto stage = Stage::open(choice, options_, stop_);
    if (!stage) {
        return stage.error();
    }
    if (stop_.stop_requested()) {
        return Error{"stopped"};
    }
    open_.emplace_back(choice, std::make_unique<Stage>(std::move(*stage)));
    return open_.back().second.get();
}

} // namespace reljef::bench
