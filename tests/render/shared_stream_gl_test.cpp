// Several terrains that show the tiles of one stream.
#include <cmath>
#include <memory>
#include <string>

#include <glm/gtc/matrix_transform.hpp>

#include "engine/scene/streaming/tile_stream.h"
#include "engine/view/select.h"
#include "tests/render/driver_fixture.h"
#include "tests/render/made_stream.h"
#include "tests/terrain/made_tiles.h"

namespace reljef::render {
namespace {

constexpr int samples_a_side = 515;

double bumps(glm::dvec2 sample) {
    return 12.0 * std::sin(0.13 * sample.x + 0.4) * std::cos(0.11 * sample.y) +
           3.0 * std::sin(0.9 * sample.x) * std::sin(0.7 * sample.y);
}

std::shared_ptr<scene::TileStream>
bumpy_stream(const std::shared_ptr<const scene::TerrainSurface>& surface) {
    const scene::TileBuilder builder(surface, terrain::TileTree(samples_a_side, samples_a_side), 1);
    return std::make_shared<scene::TileStream>(builder, [builder](terrain::TreeTile tile,
                                                                  const std::stop_token&) {
        scene::TileContent content;
        content.heights = test::tile_heights(builder.tree().cells(tile), [&](glm::ivec2 vertex) {
            return bumps(glm::clamp(builder.sample(tile, vertex), glm::dvec2(0.0),
                                    glm::dvec2(samples_a_side - 1)));
        });
        return content;
    });
}

// A terrain, and the same again: turned, behind the first one. Other levels of both are drawn.
struct TwoTerrains {
    Scene scene;
    Node* near = nullptr;
    Node* far = nullptr;

    explicit TwoTerrains(bool share_stream) {
        near = &test::add_terrain(
            scene,
            test::plane_heightfield(
                test::made_heights(samples_a_side, samples_a_side,
                                   [](int col, int row) { return bumps(glm::dvec2(col, row)); }),
                {2.0, 2.0}));
        auto& first = *near->get<scene::TerrainNode>();
        first.stream = bumpy_stream(first.surface);
        far = &scene.root().add("far", first);
        auto& second = *far->get<scene::TerrainNode>();
        if (!share_stream) {
            second.stream = bumpy_stream(first.surface);
        }
        const glm::dmat4 behind = glm::translate(glm::dmat4(1.0), {0.0, 1500.0, 200.0});
        far->set_parent_from_local(glm::rotate(behind, 1.0, glm::dvec3(0.0, 0.0, 1.0)));
        scene.add_camera(test::camera_at({0.0, -600.0, 250.0}, {0.0, 300.0, 0.0}));
        scene.add_light();
        scene.set_sky({});
    }
    void set(const std::string& near_technique, const std::string& far_technique) const {
        near->get<scene::TerrainNode>()->material.technique =
            test::must(scene::parse_technique(near_technique));
        far->get<scene::TerrainNode>()->material.technique =
            test::must(scene::parse_technique(far_technique));
    }
};

class SharedStreamGlTest : public DriverGlTest {
protected:
    struct Pictures {
        Image color;
        HitBuffer hits;
    };
    static Pictures pictures(const TwoTerrains& world) {
        Driver driver = test::must(Driver::create({.size = size, .shader_dir = {}}));
        bring_tiles(world.scene);
        const view::FrameView frame = view::select(world.scene, size);
        test::must(driver.draw(frame));
        test::must(driver.draw(frame)); // with what the first frame left
        return {driver.read_color(), test::must(driver.draw_hits(frame)).hits};
    }
    static int other_places(const HitBuffer& a, const HitBuffer& b) {
        int count = 0;
        for (int row = 0; row < size.y; ++row) {
            for (int col = 0; col < size.x; ++col) {
                const Hit& hit = a(col, row);
                const Hit& other = b(col, row);
                const bool is_same = hit.is_sky() ? other.is_sky() : hit.place() == other.place();
                count += is_same ? 0 : 1;
            }
        }
        return count;
    }
    static void expect_looks_as_with_two_streams(const std::string& near, const std::string& far) {
        const TwoTerrains shared(true);
        const TwoTerrains apart(false);
        shared.set(near, far);
        apart.set(near, far);
        const Pictures found = pictures(shared);
        const Pictures expected = pictures(apart);
        EXPECT_EQ(found.color, expected.color) << near << " " << far;
        EXPECT_EQ(other_places(found.hits, expected.hits), 0) << near << " " << far;
    }
};

TEST_F(SharedStreamGlTest, RaysOverOneStreamSearchTheTilesOfTheirOwnTerrain) {
    expect_looks_as_with_two_streams("exact", "exact");
    expect_looks_as_with_two_streams("relief", "cone");
}

TEST_F(SharedStreamGlTest, ShadowsOverOneStreamKeepTheirOwnLightMaps) {
    expect_looks_as_with_two_streams("exact:shadow=hard", "exact");
}

TEST_F(SharedStreamGlTest, TrianglesOfOneStreamAreCutAndLitForTheirOwnTerrain) {
    expect_looks_as_with_two_streams("polygons:error=1", "polygons:error=1");
    expect_looks_as_with_two_streams("polygons", "polygons");
}

TEST_F(SharedStreamGlTest, RaysAndTrianglesShareAStream) {
    expect_looks_as_with_two_streams("exact", "polygons:error=1");
}

} // namespace
} // namespace reljef::render
