#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include <gtest/gtest.h>

#include "engine/scene/graph/terrain_node.h"
#include "engine/scene/streaming/tile_stream.h"
#include "tests/terrain/made_tiles.h"

namespace reljef::test {

/// From now on, a terrain's samples are tiles of a stream; those of the finest level are proven to
/// have no error.
inline void stream_samples(scene::TerrainNode& node) {
    const Grid<float>& heights = node.surface->heightfield().heights;
    const auto& georeference = node.surface->heightfield().georeference;
    const geo::GlobalWrap wrap =
        georeference ? georeference->geodetic.rows().wrap() : geo::GlobalWrap{};
    const terrain::TileTree tree(heights.cols(), heights.rows(), wrap.east);
    const auto read = [surface = node.surface, tree](terrain::TreeTile tile,
                                                     const std::stop_token& /*stop*/) {
        scene::TileContent content;
        content.heights = tile_heights(tree.cells(tile), [&](glm::ivec2 vertex) {
            const glm::ivec2 sample = tree.sample(tile, vertex);
            return surface->heightfield().heights(sample.x, sample.y);
        });
        content.is_proven = true;
        return content;
    };
    scene::TileStreamOptions options;
    options.find_proof = [surface = node.surface](terrain::TreeTile tile) {
        const terrain::MinMax total = surface->pyramid().total();
        const float much = std::max(1e3F, total.high - total.low); // metres
        return std::optional(
            terrain::TileProof{total.low, total.high, tile.level == 0 ? 0.0F : much});
    };
    node.stream = std::make_shared<scene::TileStream>(
        scene::TileBuilder(node.surface, tree, 1, {}, wrap), read, options);
}

/// Where the samples of a test's terrain are. What is true of one is true of the other.
enum class SampleSource { memory, stream };

inline auto all_sources() {
    return testing::Values(SampleSource::memory, SampleSource::stream);
}

inline std::string name_of_source(const testing::TestParamInfo<SampleSource>& source) {
    return source.param == SampleSource::memory ? "InMemory" : "Streamed";
}

inline void give_samples(scene::TerrainNode& node, SampleSource source) {
    if (source == SampleSource::stream) {
        stream_samples(node);
    }
}

} // namespace reljef::test
