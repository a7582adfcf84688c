#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "engine/render/occlusion.h"
#include "engine/render/tile_choice.h"
#include "engine/scene/tile_stream.h"
#include "tests/render/driver_fixture.h"
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

scene::TileReading read_ridges(TreeTile tile) {
    const terrain::TileTree tree(ridge_samples, ridge_samples);
    const glm::ivec2 count = tree.cells(tile) + 3;
    scene::TileReading reading;
    reading.heights = test::made_heights(count.x, count.y, [&](int col, int row) {
        return ridge_height(glm::dvec2(tree.sample(tile, {col - 1, row - 1})));
    });
    return reading;
}

struct RidgeWorld {
    Scene scene;
    Node* camera = nullptr;
    scene::TerrainNode* terrain = nullptr;
    glm::ivec2 picture = size;

    explicit RidgeWorld(const char* technique = "polygons:error=1") {
        const int side = ridge_samples / ridge_reduction;
        auto overview = test::plane_heightfield(
            test::made_heights(side, side,
                               [](int col, int row) {
                                   return ridge_height(1.0 * ridge_reduction *
                                                           glm::dvec2(col, row) +
                                                       0.5 * (ridge_reduction - 1));
                               }),
            glm::dvec2(ridge_spacing * ridge_reduction));
        terrain = test::add_terrain(scene, std::move(overview)).get<scene::TerrainNode>();
        terrain->material.technique = scene::parse_technique(technique).value();
        camera = &scene.add_camera();
        scene.add_light();
        scene.set_sky({});
        terrain->stream = std::make_shared<scene::TileStream>(
            scene::TileMaker(terrain->surface, terrain::TileTree(ridge_samples, ridge_samples),
                             ridge_reduction),
            [](TreeTile tile, const std::stop_token&) { return read_ridges(tile); },
            scene::TileStreamOptions{.memory_budget = 400 * scene::bytes_per_tile, .threads = 2});
    }

    [[nodiscard]] TileChoice choice() const {
        return choose_tiles(*terrain, scene.camera(), picture, glm::dmat4(1.0));
    }

    void look(const Camera& view) { *camera->get<Camera>() = view; }

    void bring() const {
        for (auto wanted = choice().wanted; !wanted.empty(); wanted = choice().wanted) {
            terrain->stream->want(wanted);
            terrain->stream->wait({});
        }
    }
};

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

bool same_hits(const HitBuffer& a, const HitBuffer& b) {
    return a.size() == b.size() &&
           std::memcmp(a.samples().data(), b.samples().data(), a.samples().size_bytes()) == 0;
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

class StreamedOcclusion : public DriverGlTest {};

TEST_F(StreamedOcclusion, ThePictureIsTheSameToTheBitWithoutTheTilesThatAreHidden) {
    Driver with = driver();
    Driver without = test::must(
        Driver::create({.size = size, .shader_dir = {}, .software = true, .occlusion = false}));
    int hidden = 0;
    const std::array techniques{std::pair("polygons:error=1", 4), std::pair("polygons", 2)};
    for (const auto& [technique, views] : techniques) {
        RidgeWorld world(technique);
        test::Chance chance(21);
        for (int i = 0; i < views; ++i) {
            world.look(i % 2 == 0 ? view_from_valley(chance) : view_across_ridges(chance));
            world.bring();
            const FrameStats fewer = test::must(with.draw(world.scene));
            const FrameStats all = test::must(without.draw(world.scene));
            EXPECT_EQ(fewer.skipped.tiles_occluded,
                      all.skipped.tiles_occluded + all.tiles - fewer.tiles);
            hidden += all.tiles - fewer.tiles;
            EXPECT_EQ(with.read_color(), without.read_color()) << technique << ' ' << i;
            EXPECT_TRUE(same_hits(test::must(with.draw_hits(world.scene)),
                                  test::must(without.draw_hits(world.scene))))
                << technique << ' ' << i;
        }
    }
    EXPECT_GT(hidden, 20);
}

TEST_F(StreamedOcclusion, NothingIsSeenThroughNearerGround) {
    RidgeWorld world;
    Driver made = driver();
    test::Chance chance(22);
    const double pixels_per_radian = 0.5 * size.y / std::tan(glm::radians(0.5 * 57.3));
    for (int i = 0; i < 4; ++i) {
        world.look(view_from_valley(chance));
        world.bring();
        ASSERT_FALSE(world.choice().hidden.empty()) << i;
        const HitBuffer hits = test::must(made.draw_hits(world.scene));
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
    EXPECT_GT(world.choice().hidden_unread + static_cast<int>(world.choice().hidden.size()), 10);
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
        Driver made = driver();
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
        return world.choice().hidden.size() +
               static_cast<std::size_t>(world.choice().hidden_unread);
    };
    EXPECT_GT(hidden(), 0U);
    camera.projection = scene::ProjectionKind::orthographic;
    camera.view_height = 500.0;
    EXPECT_EQ(hidden(), 0U);
    camera.projection = scene::ProjectionKind::perspective;
    camera.eye.z -= 500.0; // under the ground
    EXPECT_EQ(hidden(), 0U);
    camera.eye.z += 500.0;
    world.terrain->material.technique = scene::make_technique(scene::TechniqueId::texture);
    EXPECT_EQ(hidden(), 0U);
}

} // namespace
} // namespace reljef::render
