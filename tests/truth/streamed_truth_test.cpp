#include "engine/truth/streamed_truth.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "engine/truth/draw.h"
#include "tests/render/made_scene.h"
#include "tests/terrain/chance.h"
#include "tests/terrain/made_heightfield.h"
#include "tests/terrain/made_tiles.h"

namespace reljef::truth {
namespace {

constexpr glm::ivec2 streamed_samples{900, 640};
constexpr glm::ivec2 rays_size{40, 30};
constexpr std::size_t no_memory = 0; // the fewest tiles and rays
constexpr int tiles_of_terrain = 15 * 10;

double rough_height(glm::dvec2 sample) {
    return 120.0 * std::sin(0.021 * sample.x) * std::cos(0.017 * sample.y) +
           9.0 * std::sin(0.9 * sample.x + 1.3 * sample.y);
}

scene::TerrainNode& terrain_of(scene::Node& node) {
    return *node.get<scene::TerrainNode>();
}

// Reads tiles of any terrain by its height function.
template <class Height> scene::TileContentReader reader_of(const Height& height) {
    return [height](terrain::TreeTile tile, const std::stop_token&) {
        const terrain::TileTree tree(streamed_samples.x, streamed_samples.y);
        scene::TileContent content;
        content.heights = test::tile_heights(tree.cells(tile), [&](glm::ivec2 vertex) {
            const glm::ivec2 sample =
                terrain::TileTree::first(tile) + vertex * terrain::TileTree::step(tile);
            return height(glm::dvec2(glm::clamp(sample, glm::ivec2(0), streamed_samples - 1)));
        });
        return content;
    };
}

struct Streamed {
    scene::Scene scene;
    scene::Node* node = nullptr;
    scene::Node* light = nullptr;

    [[nodiscard]] const scene::TerrainSurface& surface() const {
        return *terrain_of(*node).surface;
    }
    [[nodiscard]] StreamedTruth truth() const {
        return StreamedTruth::create(scene, no_memory).value();
    }
};

// The overview has a `reduction`-th of the samples.
Streamed streamed(terrain::Heightfield overview, int reduction, scene::TileContentReader read) {
    Streamed made;
    made.node = &test::add_terrain(made.scene, std::move(overview));
    made.light = &made.scene.add_light();
    made.scene.set_sky({});
    scene::TerrainNode& terrain = terrain_of(*made.node);
    scene::TileStreamOptions options;
    options.threads = 2;
    options.first_pause = std::chrono::milliseconds(1);
    terrain.stream = std::make_shared<scene::TileStream>(
        scene::TileBuilder(terrain.surface,
                           terrain::TileTree(streamed_samples.x, streamed_samples.y), reduction),
        std::move(read), options);
    return made;
}

Grid<float> all_heights() {
    return test::made_heights(streamed_samples.x, streamed_samples.y, [](int col, int row) {
        return rough_height({col, row});
    });
}

Streamed rough_on_plane() {
    return streamed(test::plane_heightfield(all_heights(), {8.0, 11.0}), 1,
                    reader_of(rough_height));
}

// In, beside, above and below the terrain, towards a place on it.
scene::Camera random_camera(test::Chance& chance, const scene::TerrainSurface& surface) {
    const Box& bounds = surface.bounds();
    const glm::dvec3 size = bounds.size();
    const auto place = [&](double beyond) {
        const glm::dvec3 share(chance.between(-beyond, 1.0 + beyond),
                               chance.between(-beyond, 1.0 + beyond), 0.0);
        return bounds.low + share * size;
    };
    scene::Camera camera;
    camera.eye = place(0.2);
    camera.eye.z = surface.height_at(camera.eye.x, camera.eye.y).value_or(bounds.high.z) +
                   (chance.one_in(6) ? -30.0 : std::exp(chance.between(0.0, 8.0)));
    camera.target = place(0.0);
    camera.target.z = bounds.center().z;
    camera.vertical_fov = chance.between(10.0, 100.0);
    return camera;
}

bool have_same_bits(const HitBuffer& a, const HitBuffer& b) {
    return std::equal(a.samples().begin(), a.samples().end(), b.samples().begin(),
                      b.samples().end(), [](const Hit& x, const Hit& y) {
                          return (x.is_sky() && y.is_sky()) ||
                                 (x.col == y.col && x.row == y.row && x.height == y.height &&
                                  x.depth == y.depth);
                      });
}

void expect_hits_of_memory(const Streamed& made, unsigned seed, int cameras) {
    StreamedTruth truth = made.truth();
    test::Chance chance(seed);
    for (int i = 0; i < cameras; ++i) {
        const scene::Camera camera = random_camera(chance, made.surface());
        const auto in_memory =
            draw_hits(SceneCaster::create(made.scene).value(), camera, rays_size);
        const auto found = truth.draw_hits(camera, rays_size);
        ASSERT_TRUE(in_memory && found);
        ASSERT_TRUE(have_same_bits(*found, *in_memory)) << i;
    }
    EXPECT_GT(truth.stats().reloaded, 0U) << "memory for a part of the tiles only";
}

TEST(StreamedTruth, HitsOnAPlaneHaveTheBitsOfTheTerrainInMemory) {
    expect_hits_of_memory(rough_on_plane(), 1, 30);
}

TEST(StreamedTruth, HitsOnTheEllipsoidHaveTheBitsOfTheTerrainInMemory) {
    expect_hits_of_memory(
        streamed(test::geographic_heightfield(all_heights(), 45.0, 6.0, 0.0009, 20.0), 1,
                 reader_of(rough_height)),
        2, 12);
}

TEST(StreamedTruth, MeshesAreWhereTheyAreOverTheTerrainInMemory) {
    Streamed made = rough_on_plane();
    const Box bounds = made.surface().bounds();
    made.scene.add_mesh(scene::box_mesh(glm::vec3(4000.0F)))
        .set_position({glm::dvec2(bounds.center()), bounds.high.z});
    scene::Camera camera;
    camera.eye = bounds.center() + glm::dvec3(0.0, -2.0 * bounds.size().y, 500.0);
    camera.target = bounds.center();
    const auto truth = made.truth().draw(camera, {32, 24});
    ASSERT_TRUE(truth) << truth.error().message;
    terrain_of(*made.node).stream = nullptr;
    const SceneCaster caster = SceneCaster::create(made.scene).value();
    const auto in_memory = draw(caster, Shading(made.scene, caster), camera, {32, 24});
    ASSERT_TRUE(in_memory);
    EXPECT_TRUE(have_same_bits(truth->hits, in_memory->hits));
    int on_mesh = 0;
    for (std::size_t i = 0; i < truth->hits.size(); ++i) {
        const Hit& hit = truth->hits.samples()[i];
        if (!hit.is_sky() && hit.col == -1.0F) {
            ++on_mesh;
            EXPECT_EQ(truth->image.samples()[i], in_memory->image.samples()[i]) << i;
        }
    }
    EXPECT_GT(on_mesh, 20);
}

// Pixels that only one of two pictures shows black.
int pixels_in_other_light(const Image& a, const Image& b) {
    int different = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        different += (a.samples()[i].r == 0) != (b.samples()[i].r == 0) ? 1 : 0;
    }
    return different;
}

// The sun alone: what it does not reach is black.
TEST(StreamedTruth, ShadowsByRaysAreThoseOverTheTerrainInMemory) {
    Streamed made = rough_on_plane();
    made.scene.root().remove(*made.light);
    made.scene.add_light({250.0, 12.0, glm::vec3(2.0F), glm::vec3(0.0F)});
    const Box bounds = made.surface().bounds();
    made.scene.add_mesh(scene::box_mesh(glm::vec3(900.0F)))
        .set_position({glm::dvec2(bounds.center()), bounds.high.z});
    scene::Camera camera;
    camera.eye = bounds.center() + glm::dvec3(0.0, -1.2 * bounds.size().y, 3000.0);
    camera.target = bounds.center();
    constexpr glm::ivec2 size{64, 48};
    const DrawOptions by_rays{.shadow = SunShadow::ray};
    const auto truth = made.truth().draw(camera, size, by_rays);
    const auto swept = made.truth().draw(camera, size);
    ASSERT_TRUE(truth && swept);
    terrain_of(*made.node).stream = nullptr;
    const SceneCaster caster = SceneCaster::create(made.scene).value();
    const auto in_memory =
        draw(caster, Shading(made.scene, caster, SunShadow::ray), camera, size, by_rays);
    ASSERT_TRUE(in_memory);
    EXPECT_LE(pixels_in_other_light(truth->image, in_memory->image),
              5); // slopes along the sun's rays
    EXPECT_GE(pixels_in_other_light(truth->image, swept->image), 50);
}

TEST(StreamedTruth, VerticalRaysOfAMapHitTheTerrain) {
    const Streamed made = rough_on_plane();
    scene::Camera camera;
    camera.projection = scene::ProjectionKind::orthographic;
    camera.eye = {0.0, 0.0, 1000.0};
    camera.target = {0.0, 0.0, 0.0};
    camera.view_height = 9000.0;
    const auto in_memory = draw_hits(SceneCaster::create(made.scene).value(), camera, rays_size);
    const auto found = made.truth().draw_hits(camera, rays_size);
    ASSERT_TRUE(in_memory && found);
    int hits = 0;
    for (std::size_t i = 0; i < found->size(); ++i) {
        const Hit& a = found->samples()[i];
        const Hit& b = in_memory->samples()[i];
        ASSERT_EQ(a.is_sky(), b.is_sky()) << i;
        hits += a.is_sky() ? 0 : 1;
        ASSERT_NEAR(a.height, a.is_sky() ? a.height : b.height, 1e-4) << i;
    }
    EXPECT_GT(hits, 400);
}

// One sample that is far higher than its surroundings, and that the overview averages away.
TEST(StreamedTruth, ATowerThatTheOverviewLacksIsHit) {
    constexpr int reduction = 4;
    const glm::dvec2 tower(500.0, 300.0);
    const auto height = [tower](glm::dvec2 sample) { return sample == tower ? 500.0 : 0.0; };
    auto overview = test::plane_heightfield(
        Grid<float>(streamed_samples.x / reduction, streamed_samples.y / reduction, 0.0F),
        glm::dvec2(40.0));
    const Streamed made = streamed(std::move(overview), reduction, reader_of(height));
    scene::Camera camera;
    const glm::dvec3 foot((tower.x - 0.5 * (streamed_samples.x - 1)) * 10.0,
                          (0.5 * (streamed_samples.y - 1) - tower.y) * 10.0, 0.0);
    camera.eye = foot + glm::dvec3(-3000.0, 0.0, 400.0);
    camera.target = foot + glm::dvec3(0.0, 0.0, 400.0);
    const auto hits = made.truth().draw_hits(camera, {33, 33});
    ASSERT_TRUE(hits);
    const Hit& middle = (*hits)(16, 16);
    EXPECT_NEAR(middle.col, 499.8, 1e-3);
    EXPECT_NEAR(middle.row, 300.0, 1e-3);
    EXPECT_NEAR(middle.height, 400.0, 1e-2);
    EXPECT_NEAR(middle.depth, 2998.0, 1e-1);
}

TEST(StreamedTruth, PicturesAreTheSameWithAnyThreadsAndMemory) {
    const Streamed made = rough_on_plane();
    test::Chance chance(3);
    scene::Camera camera = random_camera(chance, made.surface());
    DrawOptions options{.rays_per_side = 3, .parallel = {1, {}, {}}};
    const auto one = made.truth().draw(camera, {60, 45}, options);
    options.parallel.threads = 3;
    const auto three = StreamedTruth::create(made.scene, std::size_t{64} << 20U)
                           .value()
                           .draw(camera, {60, 45}, options);
    ASSERT_TRUE(one && three);
    EXPECT_TRUE(one->image == three->image);
    EXPECT_TRUE(have_same_bits(one->hits, three->hits));
}

Streamed smooth_on_plane() {
    const auto smooth = [](glm::dvec2 sample) {
        return 120.0 * std::sin(0.021 * sample.x) * std::cos(0.017 * sample.y);
    };
    return streamed(
        test::plane_heightfield(test::made_heights(streamed_samples.x, streamed_samples.y,
                                                   [&](int col, int row) {
                                                       return smooth({col, row});
                                                   }),
                                {8.0, 11.0}),
        1, reader_of(smooth));
}

void expect_colors_of_memory(const Streamed& made) {
    scene::Camera camera;
    camera.eye = {0.0, -4000.0, 3000.0};
    const auto in_memory = truth::draw(SceneCaster::create(made.scene).value(),
                                       Shading(made.scene, SceneCaster::create(made.scene).value()),
                                       camera, rays_size);
    const auto found = made.truth().draw(camera, rays_size);
    ASSERT_TRUE(in_memory && found);
    int off = 0;
    int bright = 0;
    for (std::size_t i = 0; i < found->image.size(); ++i) {
        const glm::vec3 a(linear_from_rgba8(found->image.samples()[i]));
        const glm::vec3 b(linear_from_rgba8(in_memory->image.samples()[i]));
        off += glm::distance(a, b) > 0.02F ? 1 : 0;
        bright += !found->hits.samples()[i].is_sky() && a.g > 0.05F ? 1 : 0;
    }
    EXPECT_LT(off, static_cast<int>(found->image.size()) / 50);
    EXPECT_GT(bright, static_cast<int>(found->image.size()) / 20);
}

// The normals and colours of tiles are those of the whole terrain, but for their construction.
TEST(StreamedTruth, ShowsTheColoursOfTheTerrainInMemory) {
    expect_colors_of_memory(smooth_on_plane());
}

// In the dark.
TEST(StreamedTruth, ShowsThePointLightsOfTheTerrainInMemory) {
    Streamed made = smooth_on_plane();
    auto& sun = *made.light->get<scene::Light>();
    sun.color = glm::vec3(0.0F);
    sun.ambient = glm::vec3(0.0F);
    made.scene.add_point_light({.intensity = 4e5F, .range = 2500.0F}, {100.0, -700.0, 600.0});
    made.scene.add_mesh(scene::sphere_mesh(200.0F)).set_position({500.0, -900.0, 300.0});
    expect_colors_of_memory(made);
}

TEST(StreamedTruth, AnUnreadableTileIsAnErrorAndNoGuess) {
    const auto read = [good = reader_of(rough_height)](terrain::TreeTile tile,
                                                       const std::stop_token& stop) {
        scene::TileContent content = good(tile, stop);
        if (tile.col == 3 && tile.row == 2) {
            content.errors.push_back({"a.tif", "a.tif: broken"});
        }
        return content;
    };
    const Streamed made = streamed(test::plane_heightfield(all_heights(), {8.0, 11.0}), 1, read);
    scene::Camera camera;
    camera.eye = {0.0, -6000.0, 5000.0};
    const auto hits = made.truth().draw_hits(camera, rays_size);
    ASSERT_FALSE(hits);
    EXPECT_EQ(hits.error().message, "a.tif: broken");
}

// Rays on the ellipsoid are searched up to a height that does not depend on the samples.
TEST(StreamedTruth, AHeightBeyondTheRaysOfTheEllipsoidIsAnError) {
    const auto height = [](glm::dvec2) { return 70'000.0; };
    const Streamed made =
        streamed(test::geographic_heightfield(
                     Grid<float>(streamed_samples.x, streamed_samples.y, 0.0F), 45.0, 6.0, 0.0009),
                 1, reader_of(height));
    scene::Camera camera;
    camera.eye = {0.0, 0.0, 5000.0};
    camera.target = {0.0, 1000.0, 0.0};
    const auto hits = made.truth().draw_hits(camera, rays_size);
    ASSERT_FALSE(hits);
    EXPECT_NE(hits.error().message.find("70000"), std::string::npos) << hits.error().message;
}

TEST(StreamedTruth, ATileThatFailsOnceIsReadAgain) {
    auto failures = std::make_shared<std::atomic<int>>(2);
    const auto read = [failures, good = reader_of(rough_height)](terrain::TreeTile tile,
                                                                 const std::stop_token& stop) {
        scene::TileContent content = good(tile, stop);
        if ((*failures)-- > 0) {
            content.errors.push_back({"a.tif", "a.tif: broken"});
        }
        return content;
    };
    const Streamed made = streamed(test::plane_heightfield(all_heights(), {8.0, 11.0}), 1, read);
    scene::Camera camera;
    camera.eye = {0.0, -6000.0, 5000.0};
    EXPECT_TRUE(made.truth().draw_hits(camera, rays_size));
    EXPECT_LT(*failures, 0);
}

TEST(StreamedTruth, StopsWhileATileFails) {
    const auto read = [](terrain::TreeTile, const std::stop_token&) {
        scene::TileContent content;
        content.errors.push_back({"a.tif", "a.tif: broken"});
        return content;
    };
    const Streamed made = streamed(test::plane_heightfield(all_heights(), {8.0, 11.0}), 1, read);
    std::stop_source stop;
    stop.request_stop();
    const auto hits = made.truth().draw_hits({}, rays_size, {0, stop.get_token(), {}});
    ASSERT_FALSE(hits);
    EXPECT_NE(hits.error().message.find("stopped"), std::string::npos);
}

TEST(StreamedTruth, TrueHitsHaveNoReprojectionError) {
    const Streamed made = rough_on_plane();
    scene::Camera camera;
    camera.eye = {0.0, -4000.0, 3000.0};
    StreamedTruth truth = made.truth();
    const auto hits = truth.draw_hits(camera, rays_size);
    ASSERT_TRUE(hits);
    const auto errors = truth.errors(camera, *hits, *hits);
    ASSERT_TRUE(errors);
    ASSERT_TRUE(errors->reprojection.distribution);
    EXPECT_GT(errors->reprojection.distribution->count, 300U);
    EXPECT_LT(errors->reprojection.distribution->max, 1e-3);
    EXPECT_EQ(errors->wrong, 0U);
}

// Each tile that rays need is read once if it stays in memory: rays wait for it together.
TEST(StreamedTruth, ReadsNoTileTwiceWithoutNeed) {
    const Streamed made = rough_on_plane();
    scene::Camera camera;
    camera.eye = {-3000.0, -4000.0, 3000.0};
    StreamedTruth truth = StreamedTruth::create(made.scene, std::size_t{64} << 20U).value();
    ASSERT_TRUE(truth.draw_hits(camera, {64, 48}));
    EXPECT_LE(truth.stats().loaded, static_cast<std::size_t>(tiles_of_terrain));
    EXPECT_EQ(truth.stats().reloaded, 0U);
}

} // namespace
} // namespace reljef::truth
