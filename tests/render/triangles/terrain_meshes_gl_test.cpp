#include "engine/render/triangles/terrain_meshes.h"

#include <array>
#include <atomic>
#include <chrono>
#include <cstring>
#include <thread>

#include <fmt/format.h>

#include "engine/scene/streaming/tile_stream.h"
#include "engine/view/stream_view.h"
#include "engine/view/tile_selection.h"
#include "tests/render/driver_fixture.h"
#include "tests/render/made_stream.h"
#include "tests/render/triangles/streamed_world.h"
#include "tests/session/made_session.h"
#include "tests/terrain/chance.h"
#include "tests/terrain/made_tiles.h"

namespace reljef::render {
namespace {

class TerrainMeshesGlTest : public DriverGlTest {};

int sky_pixels(const HitBuffer& hits) {
    const auto samples = hits.samples();
    return static_cast<int>(std::count_if(samples.begin(), samples.end(),
                                          [](const Hit& hit) { return hit.col < 0.0F; }));
}

std::string first_sky(const HitBuffer& hits) {
    for (int row = 0; row < hits.rows(); ++row) {
        for (int col = 0; col < hits.cols(); ++col) {
            if (hits(col, row).col < 0.0F) {
                const Hit beside = hits.clamped(col - 1, row);
                return fmt::format("the first at {},{} beside sample {},{} at {} m", col, row,
                                   beside.col, beside.row, beside.height);
            }
        }
    }
    return "";
}

TEST_F(TerrainMeshesGlTest, NoHoleBetweenTilesOfAnyLevels) {
    StreamedWorld world;
    session::SceneRenderer made = driver();
    test::Chance chance(5);
    for (int round = 0; round < 40; ++round) {
        // Down onto the ground: nothing but terrain is seen.
        const glm::dvec3 eye(chance.between(-300, 300), chance.between(-300, 300),
                             chance.between(60, 200));
        const double aside = 0.2 * eye.z;
        world.look(eye, eye + glm::dvec3(chance.between(-aside, aside),
                                         chance.between(-aside, aside), -eye.z));
        if (round % 2 == 0) {
            world.bring();
        } else {
            world.request(); // with what happens to be there
        }
        const HitBuffer hits = test::must(made.draw_hits(world.scene));
        ASSERT_EQ(sky_pixels(hits), 0) << "round " << round << ", eye " << eye.x << "," << eye.y
                                       << "," << eye.z << ", " << first_sky(hits);
    }
}

TEST_F(TerrainMeshesGlTest, AnErrorTakesFewerTrianglesOfTheSameTilesWithoutAHole) {
    StreamedWorld world;
    auto& technique = world.terrain->get<scene::TerrainNode>()->material.technique;
    const auto all = technique;
    const auto fewer = scene::parse_technique("polygons:error=1").value(); // that of the tiles
    session::SceneRenderer made = driver();
    test::Chance chance(6);
    for (int round = 0; round < 15; ++round) {
        const glm::dvec3 eye(chance.between(-300, 300), chance.between(-300, 300),
                             chance.between(60, 200));
        world.look(eye, eye + glm::dvec3(0.1 * eye.z, 0.0, -eye.z));
        world.bring();
        technique = all;
        const view::FrameStats whole = test::must(made.draw(world.scene));
        const Image picture = made.read_color();
        technique = fewer;
        const view::FrameStats cut = test::must(made.draw(world.scene));
        EXPECT_EQ(cut.tiles, whole.tiles);
        EXPECT_EQ(cut.tiles_cut, cut.tiles);
        EXPECT_LT(2 * cut.triangles, whole.triangles);
        EXPECT_EQ(test::must(made.draw(world.scene)).tiles_cut, 0);
        ASSERT_EQ(sky_pixels(test::must(made.draw_hits(world.scene))), 0) << round;
        technique = all;
        test::must(made.draw(world.scene));
        ASSERT_EQ(made.read_color(), picture) << round;
    }
}

TEST_F(TerrainMeshesGlTest, TheSameViewGivesTheSamePictureWhateverCameBefore) {
    const auto picture = [&](std::span<const glm::dvec3> before) {
        StreamedWorld world;
        session::SceneRenderer made = driver();
        for (const glm::dvec3 eye : before) {
            world.look(eye, {0.0, 0.0, 0.0});
            world.bring();
            test::must(made.draw(world.scene));
        }
        world.look({-300.0, -400.0, 180.0}, {100.0, 200.0, 0.0});
        world.bring();
        test::must(made.draw(world.scene));
        return made.read_color();
    };
    const Image first = picture({});
    EXPECT_EQ(first, picture(std::array{glm::dvec3(500.0, 500.0, 70.0),
                                        glm::dvec3(-600.0, 300.0, 400.0)}));
}

// Other neighbours, seams, coarsenings and errors of tiles.
TEST_F(TerrainMeshesGlTest, SliversAreThoseOfTheTrianglesThatAreDrawnNow) {
    StreamedWorld world;
    auto& node = *world.terrain->get<scene::TerrainNode>();
    node.material.technique = scene::parse_technique("polygons:error=1").value();
    const std::size_t enough = node.max_triangles;
    session::SceneRenderer kept = driver();
    test::Chance chance(8);
    glm::dvec3 eye(0.0);
    std::int64_t slivers = 0;
    for (int round = 0; round < 20; ++round) {
        if (round % 4 == 0) { // else the same view, with more tiles or fewer triangles
            eye = {chance.between(-700, 700), chance.between(-700, 700), chance.between(46, 60)};
            world.look(eye, eye + glm::dvec3(chance.between(-9, 9), 10.0, -1.0));
        }
        world.request();
        world.stream->wait({});
        node.max_triangles = round % 4 == 3 ? 3000 : enough;
        session::SceneRenderer fresh = driver();
        const view::FrameStats expected = test::must(fresh.draw(world.scene));
        ASSERT_EQ(test::must(kept.draw(world.scene)).slivers, expected.slivers) << round;
        const HitBuffer hits = test::must(kept.draw_hits(world.scene));
        const HitBuffer fresh_hits = test::must(fresh.draw_hits(world.scene));
        ASSERT_EQ(std::memcmp(hits.samples().data(), fresh_hits.samples().data(),
                              hits.size() * sizeof(Hit)),
                  0)
            << round;
        slivers += static_cast<std::int64_t>(expected.slivers);
    }
    EXPECT_GT(slivers, 500);
}

TEST_F(TerrainMeshesGlTest, WhatIsNotDrawnForLongLeavesTheDriversMemory) {
    StreamedWorld world;
    session::SceneRenderer made = driver();
    const auto uploads_of_ground = [&] {
        world.look({-300.0, -400.0, 180.0}, {100.0, 200.0, 0.0});
        world.bring();
        return test::must(made.draw(world.scene)).uploads;
    };
    const auto look_away = [&](int frames) {
        for (int i = 0; i < frames; ++i) {
            world.look({-300.0, -400.0, 180.0}, {-300.0, -400.0, 1e6});
            test::must(made.draw(world.scene));
        }
    };
    const auto first = uploads_of_ground();
    EXPECT_GT(first, 8);
    look_away(4);
    EXPECT_LE(uploads_of_ground(), 1); // no tile among them
    look_away(20);
    EXPECT_GT(uploads_of_ground(), first / 2);
}

// Its bisection needs it, and would hold it for many frames of a flight.
TEST_F(TerrainMeshesGlTest, ATileThatIsEvictedLeavesMemoryAtOnce) {
    StreamedWorld world(40);
    world.terrain->get<scene::TerrainNode>()->material.technique =
        scene::parse_technique("polygons:error=1").value();
    session::SceneRenderer made = driver();
    const auto look = [&](glm::dvec3 eye) {
        world.look(eye, eye + glm::dvec3(10.0, 10.0, -40.0));
        world.bring();
        test::must(made.draw(world.scene));
    };
    look({-600.0, -600.0, 80.0});
    std::vector<std::weak_ptr<const scene::TerrainTile>> finest;
    for (const view::TileSelection::Drawn& drawn : world.choice().drawn) {
        if (drawn.tile->id.level == 0) {
            finest.emplace_back(drawn.tile);
        }
    }
    ASSERT_FALSE(finest.empty());
    look({600.0, 600.0, 80.0});
    look({600.0, -600.0, 80.0});
    look({-600.0, 600.0, 80.0});
    for (const auto& tile : finest) {
        const auto held = tile.lock();
        EXPECT_TRUE(held == nullptr || world.stream->find(held->id) != nullptr);
    }
    EXPECT_GT(world.stream->stats().evicted, 0);
}

// A drawn tile onto whose vertices one beside it, of its own level, is moved.
TreeTile tile_beside_another(const view::TileSelection& choice) {
    for (const view::TileSelection::Drawn& drawn : choice.drawn) {
        const TreeTile id = drawn.tile->id;
        for (const view::TileSelection::Drawn& other : choice.drawn) {
            if (other.tile->id == TreeTile{id.level, id.col + 1, id.row}) {
                return id;
            }
        }
    }
    ADD_FAILURE() << "no two tiles of a level are drawn side by side";
    return {};
}

TEST_F(TerrainMeshesGlTest, HeightsThatRecoverReplaceTheTilesTriangles) {
    const auto look = [](StreamedWorld& world) {
        world.look({-300.0, -400.0, 180.0}, {100.0, 200.0, 0.0});
    };
    StreamedWorld whole;
    look(whole);
    whole.bring();
    const TreeTile failing = tile_beside_another(whole.choice());

    StreamedWorld world;
    std::atomic<int> readings{0};
    std::atomic<bool> recovers{false};
    const Grid<float> all = rough_hills(side, 1.0, 0.0);
    const auto read = [&](TreeTile tile, const std::stop_token& stop) {
        scene::TileContent reading = read_hills(all, tile);
        if (tile == failing && ++readings == 1) {
            for (float& height : reading.heights.samples()) {
                height += 25.0F;
            }
            reading.of_overview = true;
            reading.picture_errors = {{"a.tif", "a.tif: is cut"}};
        }
        while (tile == failing && readings > 1 && !recovers && !stop.stop_requested()) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return reading;
    };
    world.stream = std::make_shared<scene::TileStream>(
        world.stream->maker(), read,
        scene::TileStreamOptions{.memory_budget = 1600 * scene::bytes_per_tile,
                                 .threads = 2,
                                 .first_pause = std::chrono::milliseconds(1)});
    world.terrain->get<scene::TerrainNode>()->stream = world.stream;
    look(world);
    while (!world.request().requested.empty()) {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    ASSERT_TRUE(world.stream->find(failing)->of_overview);
    session::SceneRenderer made = driver();
    test::must(made.draw(world.scene));
    const Image before = made.read_color();
    recovers = true;
    world.bring();
    while (world.stream->is_busy()) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    test::must(made.draw(world.scene));
    const Image after = made.read_color();
    EXPECT_NE(after, before);
    session::SceneRenderer fresh = driver();
    test::must(fresh.draw(whole.scene));
    EXPECT_EQ(after, fresh.read_color());
}

// A tile of detail, as wide as some of its samples.
std::shared_ptr<const scene::TerrainDetail> striped_detail() {
    material::ReliefMaterial set;
    set.name = "stripes";
    set.heights =
        test::made_heights(16, 16, [](int col, int row) { return (col / 4 + row / 8) % 2; });
    set.color = Image(16, 16);
    for (int row = 0; row < 16; ++row) {
        for (int col = 0; col < 16; ++col) {
            set.color(col, row) = col < 8 ? Rgba8{220, 200, 160, 255} : Rgba8{90, 100, 140, 255};
        }
    }
    scene::TerrainDetail detail;
    detail.set = std::make_shared<const material::ReliefMaterial>(
        material::completed(std::move(set), material::WrapMode::wrap).value());
    detail.width = 6.0;
    detail.scale = 0.1F;
    detail.technique = scene::parse_technique("exact:shadow=hard").value();
    return std::make_shared<const scene::TerrainDetail>(std::move(detail));
}

// Pixels that differ by more than `limit` of 255 in green.
int pixels_off(const Image& one, const Image& other, int limit) {
    int off = 0;
    for (std::size_t i = 0; i < one.size(); ++i) {
        off += std::abs(one.samples()[i].g - other.samples()[i].g) > limit ? 1 : 0;
    }
    return off;
}

// The middle of the same hills, read whole.
struct WholeWorld {
    Scene scene;
    Node* terrain = nullptr;

    WholeWorld(const Camera& camera, const Image& picture) {
        constexpr int samples = 302;
        constexpr int seen = side / reduction * reduction; // what is beyond has no overview
        terrain = &test::add_terrain(
            scene,
            test::plane_heightfield(rough_hills(samples, 1.0, 0.5 * (seen - samples)),
                                    glm::dvec2(1.0)),
            picture);
        scene.add_camera(camera);
    }
};

TEST_F(TerrainMeshesGlTest, ATileOfDetailLiesOnThemAsOnAnyTiles) {
    const Image gray(2, 2, Rgba8{128, 128, 128, 255});
    StreamedWorld world(400, gray);
    world.look({10.0, -20.0, 60.0}, {15.0, -5.0, 30.0});
    world.bring();
    world.sun->set_visible(false); // its shadows are the overview's
    WholeWorld whole(world.scene.camera(), gray);
    session::SceneRenderer made = driver();
    const auto picture = [&](Scene& scene, Node& terrain, bool detailed) {
        terrain.get<scene::TerrainNode>()->detail = detailed ? striped_detail() : nullptr;
        test::must(made.draw(scene));
        return made.read_color();
    };
    const Image detailed = picture(world.scene, *world.terrain, true);
    EXPECT_LT(pixels_off(detailed, picture(whole.scene, *whole.terrain, true), 4), 80);
    EXPECT_GT(pixels_off(detailed, picture(world.scene, *world.terrain, false), 8), 20000);
}

TEST_F(TerrainMeshesGlTest, TextureAndTerrainDrawTiles) {
    StreamedWorld world;
    auto& material = world.terrain->get<scene::TerrainNode>()->material;
    session::SceneRenderer made = driver();
    world.bring();
    test::must(made.draw(world.scene));
    const Image hills = made.read_color();
    material.technique = scene::make_technique(scene::TechniqueId::texture);
    world.bring();
    const view::FrameStats flat = test::must(made.draw(world.scene));
    EXPECT_GT(flat.tiles, 0);
    EXPECT_NE(made.read_color(), hills);
    material.technique = scene::make_technique(scene::TechniqueId::relief);
    EXPECT_GE(test::must(made.draw(world.scene)).tiles, flat.tiles);
    EXPECT_NE(made.read_color(), hills);
}

} // namespace
} // namespace reljef::render
