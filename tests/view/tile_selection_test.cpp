#include "engine/view/tile_selection.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "engine/scene/streaming/tile_stream.h"
#include "engine/view/stream_view.h"
#include "tests/render/made_scene.h"
#include "tests/terrain/made_tiles.h"

namespace reljef::view {
namespace {

using terrain::TreeTile;

constexpr int samples = 4097;
constexpr int reduction = 16;
constexpr double spacing = 4.0; // metres
constexpr glm::ivec2 picture{320, 240};

// Ridges from north to south, one behind the other, with waves of eight samples.
double ridges(glm::dvec2 sample) {
    return 250.0 * std::sin(sample.x / 70.0) + 10.0 * std::sin(0.8 * sample.x + 0.7 * sample.y);
}

struct WorldOptions {
    std::size_t tiles = 64; // that memory holds
    bool has_images = false;
    std::function<bool(TreeTile)> has_finer_images = [](TreeTile) { return false; };
};

// A proven terrain with images.
struct World {
    scene::Scene scene;
    scene::Node* camera = nullptr;
    scene::TerrainNode* terrain = nullptr;

    explicit World(const WorldOptions& options) {
        const Grid<float> overview = test::overview_heights(samples, reduction, ridges);
        terrain = test::add_terrain(
                      scene, test::plane_heightfield(overview, glm::dvec2(spacing * reduction)))
                      .get<scene::TerrainNode>();
        terrain->material.technique = scene::Technique{scene::Polygons{.error = 1.0}};
        camera = &scene.add_camera();
        const terrain::TileTree tree(samples, samples);
        const scene::ImageryDetail images{.finest_pixel = options.has_images ? 0.5 * spacing : 0.0,
                                          .max_texels = 1};
        const scene::TileBuilder builder(terrain->surface, tree, reduction, images);
        const auto read = [tree, builder, options](TreeTile tile, const std::stop_token&) {
            scene::TileContent content;
            content.heights = test::tile_heights(tree.cells(tile), [&](glm::ivec2 vertex) {
                return ridges(
                    glm::dvec2(terrain::TileTree::first(tile) + vertex * (1 << tile.level)));
            });
            content.is_proven = true;
            if (options.has_images) {
                const glm::ivec2 size = builder.picture_size(tile);
                content.picture.texels = Image(size.x, size.y, Rgba8{200, 180, 160, 255});
                content.picture.has_more = options.has_finer_images(tile);
            }
            return content;
        };
        scene::TileStreamOptions stream;
        stream.memory_budget =
            static_cast<std::size_t>(static_cast<double>(options.tiles * builder.bytes_per_tile()) /
                                     0.6) +
            1;
        stream.threads = 2;
        stream.find_proof = [tree](TreeTile tile) {
            // Of waves of eight samples, coarser levels show less and less.
            const float rough =
                tile.level == 0 ? 0.0F : 10.0F * static_cast<float>(std::min(tile.level, 3));
            const float along_ridge =
                250.0F * std::min(1.0F, static_cast<float>(std::pow((1 << tile.level) / 140.0, 2)));
            return std::optional(terrain::TileProof{
                -260.0F, 260.0F, rough + (tile.level == 0 ? 0.0F : along_ridge)});
        };
        terrain->stream = std::make_shared<scene::TileStream>(builder, read, stream);
    }

    [[nodiscard]] TileSelection choice() const {
        return select_tiles(*terrain, scene.camera(), picture, glm::dmat4(1.0));
    }
    void look(const scene::Camera& view) { *camera->get<scene::Camera>() = view; }
    // All that the view needs.
    TileSelection load() const {
        TileSelection now = choice();
        while (!now.requested.empty()) {
            terrain->stream->request(now.requested, now.used);
            terrain->stream->wait({});
            now = choice();
        }
        return now;
    }
};

scene::Camera camera_at(glm::dvec3 eye, glm::dvec3 target) {
    scene::Camera camera;
    camera.eye = eye;
    camera.target = target;
    camera.near = 0.01;
    return camera;
}

// From the bottom of a valley, metres.
scene::Camera view_from_valley() {
    const double x = (70.0 * 1.5 * 3.14159265 - 0.5 * (samples - 1)) * spacing;
    return camera_at({x, 0.0, -200.0}, {0.0, 300.0, -170.0});
}

scene::Camera view_from_above(double x) {
    return camera_at({x, -3000.0, 2500.0}, {x, 1000.0, 0.0});
}

std::vector<TreeTile> drawn_tiles(const TileSelection& selection) {
    std::vector<TreeTile> tiles;
    for (const TileSelection::Drawn& drawn : selection.drawn) {
        tiles.push_back(drawn.tile->id);
    }
    return tiles;
}

double largest_error(const TileSelection& selection) {
    double largest = 0.0;
    for (const TileSelection::Drawn& drawn : selection.drawn) {
        largest = std::max(largest, drawn.error);
    }
    return largest;
}

// Finer images only in the west. The view before looked there.
TEST(TileSelection, OfImagesIsTheSameWhateverWasReadBefore) {
    const WorldOptions options{.has_images = true, .has_finer_images = [](TreeTile tile) {
                                   return tile.col < (32 >> tile.level);
                               }};
    for (const scene::Camera& view :
         {view_from_above(0.0), view_from_above(4000.0), view_from_valley()}) {
        World alone(options);
        alone.look(view);
        const auto expected = drawn_tiles(alone.load());
        EXPECT_GT(expected.size(), 16U);
        for (const scene::Camera& before :
             {view_from_above(-5000.0), view_from_above(2000.0), view_from_valley()}) {
            World world(options);
            world.look(before);
            world.load();
            world.look(view);
            EXPECT_EQ(drawn_tiles(world.load()), expected);
        }
    }
}

TEST(TileSelection, IsFinerWhereNearerGroundHidesTiles) {
    World world({.tiles = 100});
    world.look(view_from_valley());
    const double hiding = largest_error(world.load());
    world.terrain->material.wireframe = true; // through which all is seen
    const double seeing = largest_error(world.load());
    EXPECT_GT(seeing, 1.0);
    EXPECT_LT(1.5 * hiding, seeing);
}

TEST(TileSelection, WithTheTilesForTheBoundKeepsIt) {
    for (const scene::Camera& view : {view_from_above(0.0), view_from_above(4000.0)}) {
        World little({.tiles = 64});
        little.look(view);
        const TileSelection selection = little.load();
        const std::size_t tiles = tiles_for_bound(*little.terrain, view, picture, glm::dmat4(1.0));
        EXPECT_GT(largest_error(selection), 1.0);
        EXPECT_GT(tiles, 64U);
        World enough({.tiles = tiles});
        enough.look(view);
        const TileSelection kept = enough.load();
        EXPECT_LE(largest_error(kept), 1.0 - min_share_of_triangles);
        EXPECT_LE(tiles, kept.drawn.size() * 4 / 3);
    }
}

} // namespace
} // namespace reljef::view
