#pragma once

#include <vector>

#include <glm/mat4x4.hpp>

#include "engine/core/geometry.h"
#include "engine/view/draw_list.h"

namespace reljef::cast {

/// What a picture shows of a terrain.
struct SeenTerrain {
    const scene::TerrainNode* node = nullptr;
    glm::dmat4 world_from_local{1.0};
    Box local;              ///< around all ground that is drawn, metres
    Box samples;            ///< the same in samples of the terrain's surface and metres of height
    bool has_tiles = false; ///< those of a stream, not the samples of its surface
};

/// The terrains of a list, each once.
std::vector<SeenTerrain> seen_terrains(const view::DrawList& list);

bool is_curved(const scene::TerrainNode& node);

} // namespace reljef::cast
