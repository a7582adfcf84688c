#pragma once

#include "engine/scene/streaming/tile_stream.h"
#include "engine/view/select.h"
#include "tests/render/driver_fixture.h"

namespace reljef::render {

/// Reads until a view wants no more tiles of the scene's streams.
inline void bring_tiles(const Scene& scene, glm::ivec2 picture = size,
                        const view::SelectOptions& options = {}) {
    bool is_missing = true;
    while (is_missing) {
        is_missing = false;
        for (const view::TileRequests& tiles : view::select(scene, picture, options).requests) {
            tiles.stream->request(tiles.missing, tiles.used, tiles.with_cones);
            is_missing = is_missing || !tiles.missing.empty();
            tiles.stream->wait({});
        }
    }
}

} // namespace reljef::render
