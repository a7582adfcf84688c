#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

#include "engine/scene/streaming/tile_stream.h"
#include "engine/view/select.h"
#include "engine/view/tile_selection.h"
#include "tests/render/driver_fixture.h"
#include "tests/session/made_session.h"
#include "tests/terrain/chance.h"

namespace reljef::render {
namespace {

using terrain::TreeTile;

constexpr int ridge_samples = 3072;
constexpr int ridge_reduction = 8;
constexpr double ridge_spacing = 4.0; // metres

// Ridges one behind the other, rougher from near.
double ridge_height(glm::dvec2 sample) {
    return 250.0 * std::sin(sample.x / 70.0) + 40.0 * std::sin(sample.y / 90.0) +
           1.5 * std::sin(0.31 * sample.x + 0.42 * sample.y);
}

glm::dvec2 sample_at(glm::dvec2 place) {
    const double middle = 0.5 * (ridge_samples - 1);
    return {middle + place.x / ridge_spacing, middle - place.y / ridge_spacing};
}

// A ridge before a plain, metres.
double wall_height(glm::dvec2 sample) {
    const double from_ridge = (sample.x - 1500.0) / 40.0;
    return 60.0 * std::exp(-from_ridge * from_ridge) + 0.2 * std::sin(0.31 * sample.x);
}

// Towers of two samples a side over all of it, and how many of the first samples they take.
constexpr int from_tower_to_tower = 41; // samples

int tower_samples(int samples) {
    return 2 * (samples / from_tower_to_tower) + std::min(samples % from_tower_to_tower, 2);
}

// Of the step² samples around one.
double share_of_towers(glm::dvec2 sample, int step) {
    const glm::ivec2 first = glm::max(glm::ivec2(glm::ceil(sample - 0.5 * step)), 0);
    const auto along = [&](int at) {
        return static_cast<double>(tower_samples(at + step) - tower_samples(at)) / step;
    };
    return along(first.x) * along(first.y);
}

struct Ridges {
    const char* technique = "polygons:error=1";
    double (*ground)(glm::dvec2) = ridge_height;
    double towers = 0.0;      // metres high
    std::size_t tiles = 1600; // that memory holds
    std::function<bool(TreeTile)> fails = [](TreeTile) { return false; };
};

// Heights as means, as far as the ridges are not the same then.
scene::TileContent read_ridges(const Ridges& ridges, TreeTile tile) {
    scene::TileContent reading;
    if (ridges.fails(tile)) {
        reading.errors.push_back({"ridges.tif", "ridges.tif cannot be read"});
        return reading;
    }
    const terrain::TileTree tree(ridge_samples, ridge_samples);
    const glm::ivec2 count = tree.cells(tile) + 3;
    reading.heights = test::made_heights(count.x, count.y, [&](int col, int row) {
        const glm::dvec2 sample(tree.sample(tile, {col - 1, row - 1}));
        return ridges.ground(sample) +
               ridges.towers * share_of_towers(sample, terrain::TileTree::step(tile));
    });
    return reading;
}

terrain::Heightfield overview_of(const Ridges& ridges) {
    const int side = ridge_samples / ridge_reduction;
    return test::plane_heightfield(
        test::made_heights(side, side,
                           [&](int col, int row) {
                               const glm::dvec2 sample =
                                   1.0 * ridge_reduction * glm::dvec2(col, row) +
                                   0.5 * (ridge_reduction - 1);
                               return ridges.ground(sample) +
                                      ridges.towers * share_of_towers(sample, ridge_reduction);
                           }),
        glm::dvec2(ridge_spacing * ridge_reduction));
}

struct RidgeWorld {
    Scene scene;
    Node* camera = nullptr;
    scene::TerrainNode* terrain = nullptr;
    glm::ivec2 picture = size;

    explicit RidgeWorld(const Ridges& ridges = {}) {
        terrain = test::add_terrain(scene, overview_of(ridges)).get<scene::TerrainNode>();
        terrain->material.technique = scene::parse_technique(ridges.technique).value();
        camera = &scene.add_camera();
        scene.add_light();
        scene.set_sky({});
        terrain->stream = std::make_shared<scene::TileStream>(
            scene::TileBuilder(terrain->surface, terrain::TileTree(ridge_samples, ridge_samples),
                               ridge_reduction),
            [ridges](TreeTile tile, const std::stop_token&) { return read_ridges(ridges, tile); },
            scene::TileStreamOptions{.memory_budget = ridges.tiles * scene::bytes_per_tile,
                                     .threads = 2,
                                     .first_pause = std::chrono::milliseconds(1)});
    }

    [[nodiscard]] view::TileSelection choice(const view::TileSelectionOptions& options = {}) const {
        return view::select_tiles(*terrain, scene.camera(), picture, glm::dmat4(1.0), options);
    }

    void look(const Camera& view) { *camera->get<Camera>() = view; }

    // All that is wanted and can be read.
    void bring(const view::TileSelectionOptions& options = {}) const {
        const auto is_given_up = [&](TreeTile tile) { return terrain->stream->has_given_up(tile); };
        while (true) {
            const view::TileSelection now = choice(options);
            terrain->stream->request(now.requested, now.used);
            if (std::all_of(now.requested.begin(), now.requested.end(), is_given_up)) {
                return;
            }
            terrain->stream->wait({});
        }
    }
};

std::vector<TreeTile> drawn_tiles(const view::TileSelection& choice) {
    std::vector<TreeTile> tiles;
    for (const view::TileSelection::Drawn& drawn : choice.drawn) {
        tiles.push_back(drawn.tile->id);
    }
    return tiles;
}

int hidden_tiles(const view::TileSelection& choice) {
    return static_cast<int>(choice.hidden.size()) + choice.hidden_unread;
}

// From low down on the slope of a ridge, across the others.
Camera view_across_ridges(test::Chance& chance) {
    const double side = chance.one_in(2) ? -1.0 : 1.0;
    const glm::dvec2 at(side * chance.between(2500, 5500), chance.between(-4000, 4000));
    const double ground = ridge_height(sample_at(at));
    Camera camera = camera_at({at.x, at.y, ground + chance.between(2.0, 60.0)},
                              {0.0, chance.between(-4000, 4000), ground});
    camera.near = 0.01;
    return camera;
}

// From the bottom between two ridges, across all others.
Camera view_from_valley(test::Chance& chance) {
    const double x = -3063.0;
    const double y = chance.between(-4000, 4000);
    const double z = ridge_height(sample_at({x, y})) + chance.between(2.0, 60.0);
    Camera camera = camera_at({x, y, z}, {0.0, y + chance.between(-1000, 1000), z + 30.0});
    camera.near = 0.01;
    return camera;
}

// Over the ridge to the plain behind it.
Camera view_over_wall(test::Chance& chance) {
    const double ridge = (1500.0 - 0.5 * (ridge_samples - 1)) * ridge_spacing;
    const double y = chance.between(-4000, 4000);
    const glm::dvec3 eye(ridge - chance.between(250, 500), y, chance.between(30, 50));
    Camera camera = camera_at(eye, {ridge, y + chance.between(-300, 300), 60.0});
    camera.near = 0.01;
    return camera;
}

int pixels_off(const HitBuffer& a, const HitBuffer& b) {
    const auto other = b.samples();
    int off = 0;
    for (std::size_t i = 0; i < other.size(); ++i) {
        off += std::memcmp(&a.samples()[i], &other[i], sizeof(Hit)) == 0 ? 0 : 1;
    }
    return off;
}

// Metres that a ray is under the ground at most before a depth.
double deepest_before(const Ray& ray, double depth) {
    const double half = 0.5 * ridge_spacing * (ridge_samples - 1);
    double deepest = -1e9;
    for (double t = 1.0; t < std::min(depth, 18000.0); t *= 1.004) {
        const glm::dvec3 at = ray.at(t);
        if (std::max(std::abs(at.x), std::abs(at.y)) < half) {
            deepest = std::max(deepest, (ridge_height(sample_at(glm::dvec2(at))) - at.z) / t);
        }
    }
    return deepest;
}

class StreamedOcclusion : public DriverGlTest {
protected:
    static session::SceneRenderer driver_of_all() {
        return test::must(test::make_renderer(size, {.occlusion = false}));
    }
};

TEST_F(StreamedOcclusion, ThePictureIsTheSameToTheBitWithAllThatIsHiddenReadAndDrawn) {
    session::SceneRenderer with = driver();
    session::SceneRenderer without = driver_of_all();
    int hidden = 0;
    const std::array techniques{std::pair("polygons:error=1", 2), std::pair("polygons", 1)};
    for (const auto& [technique, views] : techniques) {
        RidgeWorld world({.technique = technique});
        test::Chance chance(21);
        for (int i = 0; i < views; ++i) {
            world.look(i % 2 == 0 ? view_from_valley(chance) : view_across_ridges(chance));
            world.bring();
            const view::FrameStats fewer = test::must(with.draw(world.scene));
            world.bring({.keeps_hidden = true});
            const view::FrameStats all = test::must(without.draw(world.scene));
            EXPECT_EQ(all.skipped.tiles_occluded, 0);
            hidden += all.tiles - fewer.tiles;
            EXPECT_EQ(with.read_color(), without.read_color()) << technique << ' ' << i;
            EXPECT_EQ(pixels_off(test::must(with.draw_hits(world.scene)),
                                 test::must(without.draw_hits(world.scene))),
                      0)
                << technique << ' ' << i;
        }
    }
    EXPECT_GT(hidden, 10);
}

// What they rise to is known only once they are read. Found: none is missed; 56 pixels would be if
// tiles that are not read were looked for no higher than what is there over them.
TEST_F(StreamedOcclusion, TowersOfTwoSamplesThatAreHigherThanNearerGroundAreSeen) {
    session::SceneRenderer with = driver();
    session::SceneRenderer without = driver_of_all();
    RidgeWorld world({.ground = wall_height, .towers = 200.0});
    test::Chance chance(26);
    world.look(view_over_wall(chance));
    world.bring();
    EXPECT_GT(hidden_tiles(world.choice()), 3);
    const HitBuffer fewer = test::must(with.draw_hits(world.scene));
    world.bring({.keeps_hidden = true});
    EXPECT_EQ(pixels_off(fewer, test::must(without.draw_hits(world.scene))), 0);
}

TEST(StreamedOcclusionChoice, WhereATileFailsNothingIsHidden) {
    test::Chance chance(23);
    const Camera camera = view_from_valley(chance);
    RidgeWorld whole;
    whole.picture = {1600, 1200};
    whole.look(camera);
    whole.bring();
    ASSERT_GT(hidden_tiles(whole.choice()), 10);
    const TreeTile farthest = drawn_tiles(whole.choice()).back();
    RidgeWorld world({.fails = [=](TreeTile tile) { return tile == farthest; }});
    world.picture = whole.picture;
    world.look(camera);
    world.bring();
    const view::TileSelection choice = world.choice();
    EXPECT_EQ(choice.requested, std::vector{farthest});
    EXPECT_EQ(hidden_tiles(choice), 0);
    world.bring({.keeps_hidden = true});
    EXPECT_EQ(drawn_tiles(world.choice()), drawn_tiles(choice)); // nothing more was needed
}

// Whatever of it is there, and on the way: an end there always is.
TEST(StreamedOcclusionChoice, OnlyWhatIsAsFineAsItShouldBeHidesWhereMemoryIsShort) {
    int hiding = 0;
    int coarse = 0;
    for (const std::size_t tiles : {1U, 240U}) {
        RidgeWorld world({.technique = "polygons:error=0.25", .towers = 60.0, .tiles = tiles});
        test::Chance chance(28);
        for (int i = 0; i < 4; ++i) {
            world.look(i % 2 == 0 ? view_from_valley(chance) : view_across_ridges(chance));
            for (int round = 0; round < 12; ++round) {
                const view::TileSelection choice = world.choice();
                double worst = 0.0; // pixels
                for (const view::TileSelection::Drawn& drawn : choice.drawn) {
                    worst = std::max(worst, drawn.error);
                }
                ASSERT_LE(choice.drawn.size(), world.terrain->stream->max_drawn());
                ASSERT_TRUE(hidden_tiles(choice) == 0 || worst <= 0.125) << worst;
                hiding += hidden_tiles(choice) > 0 ? 1 : 0;
                coarse += worst > 0.125 ? 1 : 0;
                world.terrain->stream->request(choice.requested, choice.used);
                world.terrain->stream->wait({});
            }
        }
    }
    EXPECT_GT(hiding, 0);
    EXPECT_GT(coarse, 0);
}

TEST(StreamedOcclusionChoice, TilesThatWaitForOthersStayInMemory) {
    const TreeTile failing{1, 10, 12};
    const std::array waiting{TreeTile{1, 11, 12}, TreeTile{1, 10, 13}, TreeTile{1, 11, 13}};
    RidgeWorld world({.tiles = 60, .fails = [=](TreeTile tile) { return tile == failing; }});
    world.look(camera_at({-600.0, -600.0, 900.0}, {-600.0, -590.0, 0.0}));
    world.bring();
    const scene::TileStream& stream = *world.terrain->stream;
    ASSERT_EQ(world.choice().requested, std::vector{failing});
    for (int round = 0; round < 30; ++round) {
        const view::TileSelection choice = world.choice();
        std::vector<TreeTile> requested = choice.requested;
        requested.insert(requested.end(),
                         {{0, round % 24, 0}, {0, round % 24, 23}}); // of views ahead
        world.terrain->stream->request(requested, choice.used);
        world.terrain->stream->wait({});
    }
    EXPECT_GT(stream.stats().evicted, 0);
    for (const TreeTile tile : waiting) {
        EXPECT_NE(stream.find(tile), nullptr);
    }
}

TEST_F(StreamedOcclusion, NothingIsSeenThroughNearerGround) {
    session::SceneRenderer with = driver();
    RidgeWorld world;
    test::Chance chance(22);
    const double pixels_per_radian = 0.5 * size.y / std::tan(glm::radians(0.5 * 57.3));
    for (int i = 0; i < 4; ++i) {
        world.look(view_from_valley(chance));
        world.bring();
        ASSERT_FALSE(world.choice().hidden.empty()) << i;
        const HitBuffer hits = test::must(with.draw_hits(world.scene));
        for (int y = 3; y < size.y; y += 7) {
            for (int x = 3; x < size.x; x += 7) {
                const Hit& hit = hits(x, y);
                const double depth = hit.col < 0.0F ? 1e9 : 0.98 * hit.depth;
                const Ray ray = scene::view_ray(world.scene.camera(), size, glm::dvec2(x, y) + 0.5);
                ASSERT_LE(deepest_before(ray, depth) * pixels_per_radian, 2.0)
                    << i << ": " << x << ',' << y;
            }
        }
    }
}

TEST(StreamedOcclusionChoice, TilesThatAreHiddenAreNotRead) {
    RidgeWorld world;
    world.picture = {1600, 1200};
    test::Chance chance(23);
    world.look(view_from_valley(chance));
    world.bring();
    const int read = world.terrain->stream->stats().read;
    EXPECT_GT(hidden_tiles(world.choice()), 10);
    world.terrain->material.wireframe = true; // through which all is seen
    world.bring();
    EXPECT_TRUE(world.choice().hidden.empty());
    EXPECT_LT(5 * read, 4 * world.terrain->stream->stats().read);
}

TEST_F(StreamedOcclusion, TheSameViewGivesTheSamePictureWhateverCameBefore) {
    test::Chance chance(24);
    const Camera view = view_from_valley(chance);
    const auto picture = [&](bool with_more) {
        RidgeWorld world;
        session::SceneRenderer made = driver();
        world.look(view);
        world.terrain->material.wireframe = with_more;
        world.bring();
        world.terrain->material.wireframe = false;
        world.bring();
        test::must(made.draw(world.scene));
        return made.read_color();
    };
    EXPECT_EQ(picture(false), picture(true));
}

TEST(StreamedOcclusionChoice, NothingIsHiddenWhereItIsNotSure) {
    RidgeWorld world;
    test::Chance chance(25);
    Camera camera = view_from_valley(chance);
    const auto hidden = [&] {
        world.look(camera);
        world.bring();
        return hidden_tiles(world.choice());
    };
    EXPECT_GT(hidden(), 0);
    camera.projection = scene::ProjectionKind::orthographic;
    camera.view_height = 500.0;
    EXPECT_EQ(hidden(), 0);
    camera.projection = scene::ProjectionKind::perspective;
    camera.eye.z -= 500.0; // under the ground
    EXPECT_EQ(hidden(), 0);
    camera.eye.z += 500.0;
    world.terrain->material.technique = scene::make_technique(scene::TechniqueId::texture);
    EXPECT_EQ(hidden(), 0);
}

} // namespace
} // namespace reljef::render
