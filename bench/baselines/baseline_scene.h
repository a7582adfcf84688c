#pragma once

#include <stop_token>
#include <string>

#include "bench/runner/suite_options.h"
#include "engine/core/result.h"
#include "engine/scene/graph/scene.h"

namespace reljef::bench {

/// The middle of a terrain as all programs draw it, without light and sky.
struct BaselineScene {
    scene::Scene scene;
    scene::Node* terrain = nullptr;
    scene::Node* camera = nullptr;

    [[nodiscard]] const scene::TerrainSurface& surface() const {
        return *terrain->get<scene::TerrainNode>()->surface;
    }
    [[nodiscard]] const scene::Camera& view() const { return *camera->get<scene::Camera>(); }
};

/// The middle 2^n+1 × 2^n+1 samples of a terrain on a plane. Fails with fewer than 17 × 17 samples.
Result<BaselineScene> open_baseline_scene(const std::string& terrain, const SuiteOptions& options,
                                          const std::stop_token& stop);

} // namespace reljef::bench
