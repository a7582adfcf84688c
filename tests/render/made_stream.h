#pragma once

#include "engine/scene/streaming/tile_stream.h"
#include "engine/view/tile_selection.h"
#include "tests/render/driver_fixture.h"

namespace reljef::render {

/// Reads until a view of `size` wants no more tiles of the terrain's stream.
inline void bring_tiles(const scene::TerrainNode& terrain, const scene::Camera& camera) {
    while (true) {
        const auto choice = view::select_tiles(terrain, camera, size, glm::dmat4(1.0));
        terrain.stream->request(choice.requested, choice.used, view::needs_cones(terrain));
        if (choice.requested.empty()) {
            return;
        }
        terrain.stream->wait({});
    }
}

} // namespace reljef::render
