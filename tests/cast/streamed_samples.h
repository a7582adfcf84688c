#pragma once

#include <memory>
#include <optional>
#include <stop_token>

#include "engine/scene/streaming/tile_stream.h"
#include "tests/terrain/made_tiles.h"

namespace reljef::cast {

/// From now on, a terrain's samples are tiles of a stream; those of the finest level are proven to
/// have no error.
inline void stream_samples(scene::TerrainNode& node) {
    const Grid<float>& heights = node.surface->heightfield().heights;
    const terrain::TileTree tree(heights.cols(), heights.rows());
    const auto read = [surface = node.surface, tree](terrain::TreeTile tile,
                                                     const std::stop_token& /*stop*/) {
        scene::TileContent content;
        content.heights = test::tile_heights(tree.cells(tile), [&](glm::ivec2 vertex) {
            const glm::ivec2 sample = tree.sample(tile, vertex);
            return surface->heightfield().heights(sample.x, sample.y);
        });
        content.is_proven = true;
        return content;
    };
    scene::TileStreamOptions options;
    options.find_proof = [surface = node.surface](terrain::TreeTile tile) {
        const terrain::MinMax total = surface->pyramid().total();
        constexpr float much = 1e3F; // metres
        return std::optional(
            terrain::TileProof{total.low, total.high, tile.level == 0 ? 0.0F : much});
    };
    node.stream = std::make_shared<scene::TileStream>(scene::TileBuilder(node.surface, tree, 1),
                                                      read, options);
}

} // namespace reljef::cast
