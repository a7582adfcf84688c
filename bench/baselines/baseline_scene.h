#pragma once

#include <stop_token>
#include <string>

#include "engine/core/result.h"
#include "engine/scene/graph/scene.h"

namespace reljef::bench {

/// The middle of a terrain, as it and its peers are to draw it, without light and sky.
struct BaselineScene {
    scene::Scene scene;
    scene::Node* terrain = nullptr;
    scene::Node* camera = nullptr;

    [[nodiscard]] const scene::TerrainSurface& surface() const {
        return *terrain->get<scene::TerrainNode>()->surface;
    }
    [[nodiscard]] const scene::Camera& view() const { return *camera->get<scene::Camera>(); }
};

struct BaselineSceneOptions {
    std::string terrain;
    int threads = 0; ///< 0: as many as the machine has
    bool quiet = false;
};

/// The middle 2^n+1 × 2^n+1 samples of a terrain on a plane. Fails where there are none of 17 × 17.
Result<BaselineScene> open_baseline_scene(const BaselineSceneOptions& options,
                                          const std::stop_token& stop);

} // namespace reljef::bench
