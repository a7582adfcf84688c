#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include <glm/common.hpp>
#include <gtest/gtest.h>

#include "engine/scene/graph/terrain_node.h"
#include "engine/scene/streaming/tile_stream.h"
#include "tests/terrain/made_tiles.h"

namespace reljef::test {

/// Between a tile's vertices, which are samples: how far the tile is from the samples in its cells.
inline terrain::TileProof proof_of_samples(const Grid<float>& samples,
                                           const terrain::TileTree& tree, terrain::TreeTile tile) {
    const glm::ivec2 first = tree.sample(tile, glm::ivec2(0));
    const glm::ivec2 last = tree.sample(tile, tree.cells(tile));
    terrain::TileProof proof;
    double largest = 0.0;
    for (int row = first.y; row <= last.y; ++row) {
        for (int col = first.x; col <= last.x; ++col) {
            const float height = samples(col, row);
            proof.low = std::min(proof.low, height);
            proof.high = std::max(proof.high, height);
            const glm::ivec2 cell = (glm::ivec2(col, row) - first) / terrain::TileTree::step(tile);
            const glm::ivec2 low = tree.sample(tile, cell);
            const glm::ivec2 high = tree.sample(tile, cell + 1);
            const glm::dvec2 width = tree.place(high) - tree.place(low);
            const glm::dvec2 part =
                (tree.place({col, row}) - tree.place(low)) /
                glm::mix(width, glm::dvec2(1.0), glm::equal(width, glm::dvec2(0.0)));
            const double surface =
                glm::mix(glm::mix(samples(low.x, low.y), samples(high.x, low.y), part.x),
                         glm::mix(samples(low.x, high.y), samples(high.x, high.y), part.x), part.y);
            largest = std::max(largest, std::abs(surface - height));
        }
    }
    constexpr double rounding = 1.0 + 0x1p-22; // to float
    proof.error = static_cast<float>(largest * rounding);
    return proof;
}

/// The levels of a stream's tiles that a test shows.
enum class SeenLevels { all, finest };

/// From now on, a terrain's samples are tiles of a stream, with the errors that they have; or, to
/// show only the finest level, with so large errors that no other is drawn.
inline void stream_samples(scene::TerrainNode& node, SeenLevels levels) {
    const Grid<float>& heights = node.surface->heightfield().heights;
    const auto& georeference = node.surface->heightfield().georeference;
    const geo::GlobalWrap wrap =
        georeference ? georeference->geodetic.rows().wrap() : geo::GlobalWrap{};
    const terrain::TileTree tree(heights.cols(), heights.rows(), wrap);
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
    const auto proofs = std::make_shared<std::map<terrain::TreeTile, terrain::TileProof>>();
    const auto add_proof = [&](const auto& self, terrain::TreeTile tile) -> void {
        terrain::TileProof proof = proof_of_samples(heights, tree, tile);
        if (tile.level > 0 && levels == SeenLevels::finest) {
            proof.error = std::max(1e3F, proof.high - proof.low); // metres
        }
        proofs->emplace(tile, proof);
        for (const terrain::TreeTile child : tree.children(tile)) {
            self(self, child);
        }
    };
    add_proof(add_proof, tree.root());
    scene::TileStreamOptions options;
    options.find_proof = [proofs](terrain::TreeTile tile) {
        return std::optional(proofs->at(tile));
    };
    node.stream = std::make_shared<scene::TileStream>(
        scene::TileBuilder(node.surface, tree, 1, {}, wrap), read, options);
}

/// Where the samples of a test's terrain are.
enum class SampleSource {
    memory,
    finest_tiles, ///< of a stream: what is true of samples in memory is true of them
    tiles         ///< of all levels, within their errors
};

inline auto all_sources() {
    return testing::Values(SampleSource::memory, SampleSource::finest_tiles, SampleSource::tiles);
}
/// Those that show all samples.
inline auto exact_sources() {
    return testing::Values(SampleSource::memory, SampleSource::finest_tiles);
}

inline std::string name_of_source(const testing::TestParamInfo<SampleSource>& source) {
    switch (source.param) {
    case SampleSource::memory:
        return "InMemory";
    case SampleSource::finest_tiles:
        return "FinestTiles";
    case SampleSource::tiles:
        break;
    }
    return "Tiles";
}

inline void give_samples(scene::TerrainNode& node, SampleSource source) {
    if (source != SampleSource::memory) {
        stream_samples(node, source == SampleSource::tiles ? SeenLevels::all : SeenLevels::finest);
    }
}

} // namespace reljef::test
