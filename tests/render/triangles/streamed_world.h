#pragma once

#include <cmath>
#include <memory>

#include "engine/scene/streaming/tile_stream.h"
#include "engine/view/tile_selection.h"
#include "tests/render/driver_fixture.h"
#include "tests/render/made_stream.h"
#include "tests/terrain/made_tiles.h"

namespace reljef::render {

using terrain::TreeTile;

inline constexpr int side = 1500; // samples: the last tiles are cut
inline constexpr int reduction = 8;

inline Grid<float> rough_hills(int samples, double step, double offset) {
    return test::made_heights(samples, samples, [&](int col, int row) {
        const glm::dvec2 at = glm::dvec2(col, row) * step + offset;
        return 40.0 * std::sin(0.013 * at.x) * std::cos(0.011 * at.y) +
               6.0 * std::sin(0.21 * at.x + 0.17 * at.y) + 2.0 * std::sin(0.9 * at.y);
    });
}

inline scene::TileContent read_hills(const Grid<float>& all, TreeTile tile) {
    const terrain::TileTree tree(side, side);
    scene::TileContent reading;
    reading.heights = test::tile_heights(tree.cells(tile), [&](glm::ivec2 vertex) {
        const glm::ivec2 sample = tree.sample(tile, vertex);
        // Coarser levels are higher: where two meet without their borders joined is a step.
        return all(sample.x, sample.y) + static_cast<float>(tile.level);
    });
    return reading;
}

// A rough square a kilometre and a half wide, of which an overview is in the scene.
struct StreamedWorld {
    Scene scene;
    Node* terrain = nullptr;
    Node* camera = nullptr;
    Node* sun = nullptr;
    std::shared_ptr<scene::TileStream> stream;

    explicit StreamedWorld(std::size_t tiles = 1600, const Image& picture = {}) {
        auto heightfield =
            test::plane_heightfield(rough_hills(side / reduction, reduction, 0.5 * (reduction - 1)),
                                    glm::dvec2(static_cast<double>(reduction)));
        terrain = &test::add_terrain(scene, std::move(heightfield), picture);
        camera = &scene.add_camera(pose(scene::Pose::overview, *terrain));
        sun = &scene.add_light();
        auto& node = *terrain->get<scene::TerrainNode>();
        const auto all = std::make_shared<const Grid<float>>(rough_hills(side, 1.0, 0.0));
        stream = std::make_shared<scene::TileStream>(
            scene::TileBuilder(node.surface, terrain::TileTree(side, side), reduction),
            [all](TreeTile tile, const std::stop_token&) { return read_hills(*all, tile); },
            scene::TileStreamOptions{.memory_budget = tiles * scene::bytes_per_tile, .threads = 2});
        node.stream = stream;
    }
    [[nodiscard]] view::TileSelection choice(glm::ivec2 picture = size) const {
        return view::select_tiles(*terrain->get<scene::TerrainNode>(), scene.camera(), picture,
                                  glm::dmat4(1.0));
    }
    // Requests what the view needs, and does not wait.
    view::TileSelection request() const {
        view::TileSelection chosen = choice();
        stream->request(chosen.requested, chosen.used);
        return chosen;
    }
    void bring() const { bring_tiles(scene); }
    void look(glm::dvec3 eye, glm::dvec3 at) { *camera->get<Camera>() = camera_at(eye, at); }
};

} // namespace reljef::render
