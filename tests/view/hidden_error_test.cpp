// Random views of a town, from its streets and from above its roofs, with too little memory.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/scene/streaming/tile_stream.h"
#include "engine/view/nearer_ground.h"
#include "engine/view/stream_view.h"
#include "engine/view/tile_selection.h"
#include "tests/render/made_scene.h"
#include "tests/terrain/made_tiles.h"

namespace reljef::view::town {
namespace {

using terrain::TreeTile;

constexpr int side = 2049; // samples, a metre apart
constexpr int cells = side - 1;
constexpr int tiles_a_side = cells / terrain::tree_tile_cells;
constexpr int reduction = 16;
constexpr int block = 20; // samples: a house and half of the streets around it
constexpr int street = 8; // samples across
constexpr glm::ivec2 picture{160, 120};
constexpr double bound = 1.0;         // pixels
constexpr std::size_t few_tiles = 64; // of 1365

double between(std::mt19937& random, double low, double high) {
    return low + (high - low) * static_cast<double>(random()) * 0x1p-32;
}

// Places of samples on a plane, as terrain::Placement has them.
glm::dvec3 world_of(glm::dvec2 sample, double height) {
    return {sample.x + 0.5 - 0.5 * cells, 0.5 * cells - sample.y - 0.5, height};
}

glm::dvec2 sample_of(glm::dvec3 world) {
    return {world.x - 0.5 + 0.5 * cells, 0.5 * cells - 0.5 - world.y};
}

double ground_at(glm::dvec2 sample) {
    return 4.0 * std::sin(0.011 * sample.x) * std::cos(0.013 * sample.y);
}

// Houses whose walls are a sample wide, and a true proof of each tile.
struct Town {
    Grid<float> heights;
    std::map<TreeTile, terrain::TileProof> proofs;

    Town() : heights(side, side) {
        constexpr int blocks = side / block + 1;
        std::mt19937 random(5);
        Grid<double> houses(blocks, blocks);
        for (double& house : houses.samples()) {
            house = 6.0 + 30.0 * std::pow(between(random, 0.0, 1.0), 3.0);
        }
        for (int row = 0; row < side; ++row) {
            for (int col = 0; col < side; ++col) {
                const bool is_street = col % block < street || row % block < street;
                heights(col, row) =
                    static_cast<float>(ground_at(glm::dvec2(col, row)) +
                                       (is_street ? 0.0 : houses(col / block, row / block)));
            }
        }
        for (int level = 0; (tiles_a_side >> level) > 0; ++level) {
            const int tiles = tiles_a_side >> level;
            for (int i = 0; i < tiles * tiles; ++i) {
                const TreeTile tile{level, i % tiles, i / tiles};
                proofs.emplace(tile, proof_of(tile));
            }
        }
    }

    // Of a tile that shows every 2^level-th sample.
    [[nodiscard]] terrain::TileProof proof_of(TreeTile tile) const {
        constexpr int last_exact = 2;
        const int step = 1 << tile.level;
        const glm::ivec2 first = terrain::TileTree::first(tile);
        terrain::TileProof proof;
        double error = 0.0;
        for (int row = first.y; row <= first.y + terrain::tree_tile_cells * step; ++row) {
            for (int col = first.x; col <= first.x + terrain::tree_tile_cells * step; ++col) {
                const float height = heights(col, row);
                proof.low = std::min(proof.low, height);
                proof.high = std::max(proof.high, height);
                if (tile.level > 0 && tile.level <= last_exact) {
                    error = std::max(error, std::abs(height - shown_at({col, row}, step)));
                }
            }
        }
        proof.error = tile.level <= last_exact ? static_cast<float>(error * (1.0 + 0x1p-20))
                                               : proof.high - proof.low;
        return proof;
    }

    [[nodiscard]] double shown_at(glm::ivec2 sample, int step) const {
        const glm::ivec2 low = sample / step * step;
        const glm::ivec2 high = glm::min(low + step, cells);
        const double across = static_cast<double>(sample.x - low.x) / step;
        const double down = static_cast<double>(sample.y - low.y) / step;
        return (1.0 - down) *
                   ((1.0 - across) * heights(low.x, low.y) + across * heights(high.x, low.y)) +
               down * ((1.0 - across) * heights(low.x, high.y) + across * heights(high.x, high.y));
    }
};

const Town& the_town() {
    static const Town town;
    return town;
}

class World {
public:
    explicit World(std::size_t tiles) {
        const Grid<float> overview = test::overview_heights(side, reduction, [](glm::dvec2 sample) {
            return terrain::bilinear_height(the_town().heights.view(), sample);
        });
        terrain_ =
            test::add_terrain(scene_, test::plane_heightfield(overview, glm::dvec2(reduction)))
                .get<scene::TerrainNode>();
        terrain_->material.technique = scene::Technique{scene::Polygons{.error = bound}};
        camera_ = &scene_.add_camera();
        stream(tiles);
    }

    [[nodiscard]] scene::Camera camera() const { return scene_.camera(); }
    [[nodiscard]] std::size_t max_drawn() const { return terrain_->stream->max_drawn(); }
    void look(const scene::Camera& view) { *camera_->get<scene::Camera>() = view; }
    [[nodiscard]] StreamView view() const {
        return {*terrain_, *camera_->get<scene::Camera>(), picture, world_from_local_};
    }
    /// As if nothing hid anything.
    void look_through() { terrain_->material.wireframe = true; }
    /// The tiles of a view, after all that it needs was loaded.
    [[nodiscard]] TileSelection load() const {
        TileSelection now = choice();
        while (!now.requested.empty()) {
            terrain_->stream->request(now.requested, now.used);
            terrain_->stream->wait({});
            now = choice();
        }
        return now;
    }

private:
    [[nodiscard]] TileSelection choice() const {
        return select_tiles(*terrain_, scene_.camera(), picture, world_from_local_);
    }

    void stream(std::size_t tiles) {
        const terrain::TileTree tree(side, side);
        const scene::TileBuilder builder(terrain_->surface, tree, reduction);
        const auto read = [tree](TreeTile tile, const std::stop_token& /*stop*/) {
            scene::TileContent content;
            content.heights = test::tile_heights(tree.cells(tile), [&](glm::ivec2 vertex) {
                const glm::ivec2 sample = glm::clamp(
                    terrain::TileTree::first(tile) + vertex * (1 << tile.level), 0, cells);
                return the_town().heights(sample.x, sample.y);
            });
            content.is_proven = true;
            return content;
        };
        constexpr double share_of_tiles = 0.6;
        scene::TileStreamOptions options;
        options.memory_budget = static_cast<std::size_t>(
            static_cast<double>(tiles * builder.bytes_per_tile()) / share_of_tiles + 1.0);
        options.threads = 2;
        options.find_proof = [](TreeTile tile) {
            return std::optional(the_town().proofs.at(tile));
        };
        terrain_->stream = std::make_shared<scene::TileStream>(builder, read, options);
    }

    const glm::dmat4 world_from_local_{1.0};
    scene::Scene scene_;
    scene::Node* camera_ = nullptr;
    scene::TerrainNode* terrain_ = nullptr;
};

// From a crossing, `above` metres above it.
scene::Camera random_view(std::mt19937& random, double above) {
    const glm::dvec2 crossing(glm::ivec2(between(random, 4.0, 96.0), between(random, 4.0, 96.0)));
    const glm::dvec2 sample = static_cast<double>(block) * crossing +
                              glm::dvec2(between(random, 2.0, 5.0), between(random, 2.0, 5.0));
    const double azimuth = between(random, 0.0, 6.2831853);
    scene::Camera camera;
    camera.eye = world_of(sample, ground_at(sample) + above);
    camera.target =
        camera.eye + glm::dvec3(std::cos(azimuth), std::sin(azimuth), between(random, -0.15, 0.1));
    camera.near = 0.01;
    return camera;
}

bool has_smaller_error(const TileSelection::Drawn& a, const TileSelection::Drawn& b) {
    return a.error < b.error;
}

double largest_error(const TileSelection& selection) {
    return std::max_element(selection.drawn.begin(), selection.drawn.end(), has_smaller_error)
        ->error;
}

std::vector<std::pair<TreeTile, double>> tiles_and_errors(const TileSelection& selection) {
    std::vector<std::pair<TreeTile, double>> tiles;
    for (const TileSelection::Drawn& drawn : selection.drawn) {
        tiles.emplace_back(drawn.tile->id, drawn.error);
    }
    return tiles;
}

// The ground that the tiles of a selection show, seen by a camera.
class ShownGround {
public:
    ShownGround(const scene::Camera& camera, const TileSelection& selection)
        : eye_(camera.eye), axes_(scene::view_axes(camera)),
          focal_(0.5 * picture.y / std::tan(0.5 * glm::radians(camera.vertical_fov))) {
        for (const TileSelection::Drawn& drawn : selection.drawn) {
            const int tiles = 1 << drawn.tile->id.level; // of level 0, along a side
            for (int i = 0; i < tiles * tiles; ++i) {
                const glm::ivec2 at = glm::ivec2(drawn.tile->id.col, drawn.tile->id.row) * tiles +
                                      glm::ivec2(i % tiles, i / tiles);
                tiles_(at.x, at.y) = drawn.tile.get();
            }
        }
    }

    /// How far the pixel that shows a place of the ground is off; 0 outside of the picture.
    [[nodiscard]] double error_at(glm::dvec2 sample) const {
        const auto shown = pixel_of(world_of(sample, height_at(sample)));
        const auto place =
            pixel_of(world_of(sample, terrain::bilinear_height(the_town().heights.view(), sample)));
        const bool is_inside =
            shown && std::abs(shown->x) < 0.5 * picture.x && std::abs(shown->y) < 0.5 * picture.y;
        return !is_inside ? 0.0
                          : (place ? glm::distance(*shown, *place)
                                   : std::numeric_limits<double>::infinity());
    }

    /// Whether the ground below the eye is drawn.
    [[nodiscard]] bool is_below_eye() const { return std::isfinite(height_at(sample_of(eye_))); }

    /// Whether no ground lies between the eye and a place of the ground.
    [[nodiscard]] bool is_seen(glm::dvec2 sample) const {
        constexpr double step = 0.125;   // metres
        constexpr double lowered = 0.02; // metres that a ray may be below the ground
        const glm::dvec3 place = world_of(sample, height_at(sample) + lowered);
        const double distance = glm::distance(eye_, place);
        const glm::dvec3 way = (place - eye_) / distance;
        for (double along = step; along < distance; along += step) {
            const glm::dvec3 at = eye_ + along * way;
            if (at.z < height_at(sample_of(at))) {
                return false;
            }
        }
        return true;
    }

private:
    [[nodiscard]] double height_at(glm::dvec2 sample) const {
        if (!(sample.x >= 0.0 && sample.y >= 0.0 && sample.x < cells && sample.y < cells)) {
            return -std::numeric_limits<double>::infinity();
        }
        const glm::ivec2 at = glm::ivec2(sample) / terrain::tree_tile_cells;
        const scene::TerrainTile* const tile = tiles_(at.x, at.y);
        return tile == nullptr ? -std::numeric_limits<double>::infinity()
                               : terrain::bilinear_height(
                                     tile->heightfield.heights.view(),
                                     (sample - glm::dvec2(terrain::TileTree::first(tile->id))) /
                                         static_cast<double>(1 << tile->id.level));
    }

    [[nodiscard]] std::optional<glm::dvec2> pixel_of(glm::dvec3 world) const {
        const glm::dvec3 seen = world - eye_;
        const double depth = glm::dot(axes_.forward, seen);
        return depth > 0.0 ? std::optional(
                                 focal_ / depth *
                                 glm::dvec2(glm::dot(axes_.right, seen), glm::dot(axes_.up, seen)))
                           : std::nullopt;
    }

    glm::dvec3 eye_;
    scene::ViewAxes axes_;
    double focal_;
    Grid<const scene::TerrainTile*> tiles_{tiles_a_side, tiles_a_side};
};

// Random places of the tiles that are not exact, those with the largest errors first.
struct Place {
    glm::dvec2 sample{0.0};
    double error = 0.0;  // pixels
    double stated = 0.0; // by its tile
};
std::vector<Place> shown_places(const ShownGround& ground, const TileSelection& selection,
                                std::mt19937& random) {
    constexpr int a_tile = 400;
    std::vector<Place> places;
    for (const TileSelection::Drawn& drawn : selection.drawn) {
        for (int i = 0; i < (drawn.tile->id.level > 0 ? a_tile : 0); ++i) {
            const double span = terrain::tree_tile_cells << drawn.tile->id.level;
            const glm::dvec2 inside(between(random, 0.0, span), between(random, 0.0, span));
            const glm::dvec2 sample = glm::dvec2(terrain::TileTree::first(drawn.tile->id)) + inside;
            places.push_back({sample, ground.error_at(sample), drawn.error});
        }
    }
    std::sort(places.begin(), places.end(),
              [](const Place& a, const Place& b) { return a.error > b.error; });
    return places;
}

TEST(HiddenError, OfPlacesThatAreSeenIsStated) {
    std::mt19937 random(1);
    int seen = 0;
    for (int i = 0; i < 20; ++i) {
        World world(few_tiles);
        world.look(random_view(random, between(random, 1.0, i % 4 == 0 ? 5.0 : 40.0)));
        const TileSelection selection = world.load();
        const ShownGround ground(world.camera(), selection);
        int looked_at = 0;
        for (const Place& place : shown_places(ground, selection, random)) {
            if (place.error > place.stated) {
                EXPECT_FALSE(ground.is_seen(place.sample)) << "view " << i;
            } else if (place.error > 0.5 * bound && ++looked_at < 200) {
                seen += ground.is_seen(place.sample) ? 1 : 0;
            }
        }
    }
    EXPECT_GT(seen, 10);
}

// The horizon that lowered the largest error hides no more of it.
TEST(HiddenError, LargestIsNotOfGroundThatAFinerHorizonHides) {
    constexpr int resolution = 8; // of the horizon for the largest errors
    std::mt19937 random(2);
    int compared = 0;
    int lowered = 0;
    for (int i = 0; i < 24; ++i) {
        World world(few_tiles);
        world.look(random_view(random, between(random, 1.0, 10.0)));
        const TileSelection selection = world.load();
        const auto largest =
            std::max_element(selection.drawn.begin(), selection.drawn.end(), has_smaller_error);
        const ShownGround ground(world.camera(), selection);
        const StreamView view = world.view();
        if (largest->error <= view.max_kept_error() || !ground.is_below_eye()) {
            continue;
        }
        NearerGround nearer(view.builder(), view.horizon());
        for (const TileSelection::Drawn& drawn : selection.drawn) {
            nearer.add(drawn.tile);
        }
        NearerGround finer = nearer.finer(resolution);
        const auto is_hidden = [&](const Box& box) { return finer.hides(box, view.along(box)); };
        EXPECT_GE(view.tight_error_of(*largest->tile, is_hidden), largest->error) << "view " << i;
        EXPECT_GE(largest->error_with_hidden, largest->error);
        lowered += largest->error_with_hidden > largest->error ? 1 : 0;
        ++compared;
    }
    EXPECT_GT(compared, 6);
    EXPECT_GT(lowered, 3);
}

TEST(HiddenError, LeavesTheMemoryToWhatIsSeen) {
    std::mt19937 random(3);
    int over = 0;
    for (int i = 0; i < 40; ++i) {
        World world(few_tiles + static_cast<std::size_t>(i));
        world.look(random_view(random, between(random, 1.0, 10.0)));
        const TileSelection selection = world.load();
        const double largest = largest_error(selection);
        EXPECT_LE(selection.drawn.size(), world.max_drawn());
        if (largest > bound) {
            ++over;
            EXPECT_GE(selection.drawn.size(), world.max_drawn() * 3 / 4) << "view " << i;
        }
        world.look_through();
        EXPECT_LE(largest, largest_error(world.load())) << "view " << i;
    }
    EXPECT_GT(over, 10);
}

TEST(HiddenError, IsThatOfTheViewWhateverWasReadBefore) {
    std::mt19937 random(4);
    for (int i = 0; i < 8; ++i) {
        const scene::Camera before = random_view(random, between(random, 1.0, 40.0));
        const scene::Camera view = random_view(random, between(random, 1.0, 10.0));
        World alone(few_tiles);
        alone.look(view);
        World world(few_tiles);
        world.look(before);
        static_cast<void>(world.load());
        world.look(view);
        EXPECT_EQ(tiles_and_errors(world.load()), tiles_and_errors(alone.load())) << "view " << i;
    }
}

} // namespace
} // namespace reljef::view::town
