// A terrain cut into the tiles of a stream gives the picture of the uncut terrain.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/core/bilinear.h"
#include "engine/scene/streaming/tile_stream.h"
#include "engine/terrain/field/surface_caster.h"
#include "engine/view/select.h"
#include "tests/render/driver_fixture.h"
#include "tests/render/made_stream.h"
#include "tests/terrain/made_tiles.h"

namespace reljef::render {
namespace {

using scene::Pose;
using terrain::TreeTile;

double rough_hill(glm::dvec2 sample) {
    return 12.0 * (0.6 * std::sin(0.13 * sample.x + 0.4) * std::cos(0.11 * sample.y) +
                   0.4 * std::sin(0.05 * sample.x - 0.07 * sample.y)) +
           3.0 * std::sin(0.9 * sample.x) * std::sin(0.7 * sample.y);
}

struct CutWorld {
    Scene scene;
    Node* terrain = nullptr;
    Node* camera = nullptr;
    glm::ivec2 samples;

    // The overview has all samples, so that heights, colours and shadows are the same.
    explicit CutWorld(glm::ivec2 sides, bool is_cut, double exaggeration = 1.0,
                      bool is_on_earth = false)
        : samples(sides) {
        const auto heights = test::made_heights(
            sides.x, sides.y, [](int col, int row) { return rough_hill(glm::dvec2(col, row)); });
        constexpr double two_metres = 1.8e-5; // degrees
        terrain = &test::add_terrain(
            scene,
            is_on_earth ? test::geographic_heightfield(heights, 47.0, 7.0, two_metres)
                        : test::plane_heightfield(heights, {2.0, 2.0}),
            {}, {.placement = {}, .exaggeration = exaggeration});
        camera = &scene.add_camera({});
        scene.add_light();
        scene.set_sky({});
        look(Pose::overview);
        auto& node = *terrain->get<scene::TerrainNode>();
        if (is_cut) {
            const scene::TileBuilder builder(node.surface, terrain::TileTree(sides.x, sides.y), 1);
            node.stream = std::make_shared<scene::TileStream>(
                builder, [builder](TreeTile tile, const std::stop_token&) {
                    scene::TileContent content;
                    content.heights =
                        test::tile_heights(builder.tree().cells(tile), [&](glm::ivec2 vertex) {
                            const glm::dvec2 last(builder.tree().cols() - 1,
                                                  builder.tree().rows() - 1);
                            return rough_hill(
                                glm::clamp(builder.sample(tile, vertex), glm::dvec2(0.0), last));
                        });
                    return content;
                });
        }
    }
    void look(Pose pose) { *camera->get<Camera>() = render::pose(pose, *terrain); }
    void set(const std::string& technique) {
        terrain->get<scene::TerrainNode>()->material.technique =
            test::must(scene::parse_technique(technique));
    }
    [[nodiscard]] view::FrameView selected() const {
        bring_tiles(scene);
        return view::select(scene, size);
    }
    /// With the tiles of the given level, and the root.
    [[nodiscard]] view::FrameView selected_at(int level) const {
        view::FrameView frame = selected();
        scene::TileStream& stream = *terrain->get<scene::TerrainNode>()->stream;
        const terrain::TileTree& tree = stream.tree();
        std::vector<TreeTile> tiles{tree.root()};
        const int side = terrain::tree_tile_cells << level;
        for (int row = 0; row * side < tree.rows() - 1; ++row) {
            for (int col = 0; col * side < tree.cols() - 1; ++col) {
                tiles.push_back({level, col, row});
            }
        }
        stream.request(tiles, {}, true);
        stream.wait({});
        auto& shown = frame.list.terrains.at(0).search->tiles;
        shown.clear();
        for (const TreeTile tile : tiles) {
            shown.push_back(stream.find(tile));
        }
        return frame;
    }
};

class StreamedReliefGlTest : public DriverGlTest {
protected:
    static Driver made_driver() {
        return test::must(Driver::create({.size = size, .shader_dir = {}}));
    }
};

struct Difference {
    int sky = 0;        // pixels that show sky in one picture only
    int moved = 0;      // hits more than a hundredth of a sample apart
    int colored = 0;    // pixels whose colours differ clearly
    double color = 0.0; // mean difference of the channels
    int ground = 0;     // hits
};

int channel_difference(Rgba8 a, Rgba8 b) {
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

Difference difference(const HitBuffer& a, const HitBuffer& b, const Image& seen_a,
                      const Image& seen_b) {
    Difference found;
    for (int row = 0; row < size.y; ++row) {
        for (int col = 0; col < size.x; ++col) {
            const Hit& hit = a(col, row);
            const Hit& other = b(col, row);
            const int apart = channel_difference(seen_a(col, row), seen_b(col, row));
            found.colored += apart > 12 ? 1 : 0;
            found.color += static_cast<double>(apart) / (size.x * size.y);
            if (hit.is_sky() != other.is_sky()) {
                ++found.sky;
            } else if (!hit.is_sky()) {
                ++found.ground;
                found.moved += glm::distance(hit.place(), other.place()) > 0.01 ? 1 : 0;
            }
        }
    }
    return found;
}

// All techniques show the same worlds, whose cones take long to find.
struct SameGround {
    CutWorld whole;
    CutWorld cut;

    explicit SameGround(bool is_on_earth)
        : whole({257, 193}, false, 1.0, is_on_earth), cut({257, 193}, true, 1.0, is_on_earth) {}
};

class StreamedTechniqueGlTest : public StreamedReliefGlTest,
                                public ::testing::WithParamInterface<std::string> {
protected:
    static void TearDownTestSuite() {
        on_plane_.reset();
        on_earth_.reset();
    }
    static SameGround& ground(bool is_on_earth) {
        auto& ground = is_on_earth ? on_earth_ : on_plane_;
        if (!ground) {
            ground = std::make_unique<SameGround>(is_on_earth);
        }
        return *ground;
    }

private:
    static inline std::unique_ptr<SameGround> on_plane_;
    static inline std::unique_ptr<SameGround> on_earth_;
};

// Rays begin at other roundings: at silhouettes, and where a step ends close to the surface, they
// may find another place. Cones end at the borders of tiles.
void expect_cut_looks_as_uncut(const std::string& technique, bool is_on_earth, SameGround& ground) {
    auto& [whole, cut] = ground;
    Driver driver = test::must(Driver::create({.size = size, .shader_dir = {}}));
    for (const Pose pose : {Pose::overview, Pose::low, is_on_earth ? Pose::oblique : Pose::map}) {
        for (CutWorld* const world : {&whole, &cut}) {
            world->set(technique);
            world->look(pose);
        }
        const view::FrameView uncut = whole.selected();
        const view::FrameView tiles = cut.selected_at(0);
        const HitBuffer hits = test::must(driver.draw_hits(uncut)).hits;
        const HitBuffer of_tiles = test::must(driver.draw_hits(tiles)).hits;
        test::must(driver.draw(uncut));
        const Image seen = driver.read_color();
        test::must(driver.draw(tiles));
        const Difference found = difference(hits, of_tiles, seen, driver.read_color());
        const int allowed = size.x * size.y / 1000;
        EXPECT_GT(found.ground, size.x * size.y / 8);
        EXPECT_LE(found.sky, allowed);
        // Each iteration multiplies roundings by the slope of a flat ray.
        const bool iterates = technique == "parallax-iterated";
        EXPECT_LE(found.moved, iterates ? 30 * allowed : allowed);
        EXPECT_LE(found.colored, 12 * allowed);
        EXPECT_LE(found.color, 1.2);
    }
}

TEST_P(StreamedTechniqueGlTest, CutTerrainLooksAsUncut) {
    expect_cut_looks_as_uncut(GetParam(), false, ground(false));
}

TEST_P(StreamedTechniqueGlTest, CutTerrainLooksAsUncutOnTheEllipsoid) {
    expect_cut_looks_as_uncut(GetParam(), true, ground(true));
}

INSTANTIATE_TEST_SUITE_P(
    Techniques, StreamedTechniqueGlTest,
    ::testing::Values("parallax", "parallax-limited", "parallax-iterated", "steep", "relief",
                      "interval", "pom", "cone:n=1024,step=0.1", "exact", "exact:depth=write",
                      "exact:shadow=hard", "exact:shadow=soft", "relief:edges=smooth",
                      "relief:steps=12..48", "exact:fade=0.2..1", "relief:fade=0.2..1",
                      "cone:n=1024,step=0.1,shadow=hard", "relief:shadow=soft"),
    [](const auto& info) {
        std::string name = info.param;
        std::replace_if(
            name.begin(), name.end(), [](char c) { return std::isalnum(c) == 0; }, '_');
        return name;
    });

// Where a tile's heights are at a sample of the terrain.
double tile_height(const scene::TileBuilder& builder, const scene::TerrainTile& tile,
                   glm::dvec2 sample) {
    return terrain::bilinear_height(tile.heightfield.heights.view(),
                                    builder.lattice(tile.id).from_terrain(sample));
}

const scene::TerrainTile& finest_at(const scene::TileBuilder& builder,
                                    const view::TerrainDraw& draw, glm::dvec2 sample) {
    for (auto tile = draw.search->tiles.rbegin(); tile != draw.search->tiles.rend(); ++tile) {
        const terrain::TileLattice lattice = builder.lattice((*tile)->id);
        if (glm::all(glm::greaterThanEqual(sample, lattice.first - 1e-3)) &&
            glm::all(glm::lessThanEqual(sample, lattice.last + 1e-3))) {
            return **tile;
        }
    }
    return *draw.search->tiles.front();
}

// Tiles of several levels, and sides whose last cells are cut.
TEST_F(StreamedReliefGlTest, HitsLieOnTheFinestTileAndOnTheirRay) {
    Driver driver = made_driver();
    for (const glm::ivec2 sides : {glm::ivec2(515, 390), glm::ivec2(700, 131)}) {
        CutWorld cut(sides, true);
        cut.set("exact");
        for (const Pose pose : {Pose::overview, Pose::low, Pose::grazing}) {
            cut.look(pose);
            const view::FrameView frame = cut.selected();
            const view::TerrainDraw& draw = frame.list.terrains.at(0);
            ASSERT_GT(draw.search->tiles.front()->id.level, draw.search->tiles.back()->id.level);
            const scene::TileBuilder& builder = draw.terrain->stream->maker();
            const HitBuffer hits = test::must(driver.draw_hits(frame)).hits;
            const glm::dmat4 clip_from_world = scene::clip_from_world(frame.list.camera, size);
            int off_pixel = 0;
            int off_tile = 0;
            int ground = 0;
            for (int row = 0; row < size.y; ++row) {
                for (int col = 0; col < size.x; ++col) {
                    const Hit& hit = hits(col, row);
                    if (hit.is_sky()) {
                        continue;
                    }
                    ++ground;
                    const glm::dvec3 world =
                        surface_of(*cut.terrain)
                            .placement()
                            .world_from_sample({hit.place(), static_cast<double>(hit.height)});
                    const glm::dvec4 clip = clip_from_world * glm::dvec4(world, 1.0);
                    const glm::dvec2 seen =
                        (glm::dvec2(0.5, -0.5) * glm::dvec2(clip) / clip.w + 0.5) *
                        glm::dvec2(size);
                    off_pixel += glm::distance(seen, glm::dvec2(col + 0.5, row + 0.5)) > 0.05;
                    const double height =
                        tile_height(builder, finest_at(builder, draw, hit.place()), hit.place());
                    off_tile += std::abs(height - static_cast<double>(hit.height)) > 0.02;
                }
            }
            EXPECT_GT(ground, 1000);
            // At the step between two levels a hit is on the wall, below the finer tile's border.
            EXPECT_LE(off_tile, ground / 500) << sides.x << " " << static_cast<int>(pose);
            EXPECT_LE(off_pixel, ground / 500) << sides.x << " " << static_cast<int>(pose);
        }
    }
}

// Between ground there is no sky: neighbours of any levels join.
TEST_F(StreamedReliefGlTest, NoSkyShowsBetweenTiles) {
    Driver driver = made_driver();
    CutWorld cut({515, 515}, true);
    for (const char* const technique : {"exact", "cone"}) {
        cut.set(technique);
        for (const Pose pose : {Pose::overview, Pose::low}) {
            cut.look(pose);
            const HitBuffer hits = test::must(driver.draw_hits(cut.selected())).hits;
            int holes = 0;
            for (int row = 1; row < size.y; ++row) {
                for (int col = 0; col < size.x; ++col) {
                    holes += hits(col, row).is_sky() && !hits(col, row - 1).is_sky() ? 1 : 0;
                }
            }
            EXPECT_EQ(holes, 0) << technique << " " << static_cast<int>(pose);
        }
    }
}

// Pages of a coarse tile show it only where nothing finer is drawn.
TEST_F(StreamedReliefGlTest, TilesAboveTheDrawnOnesChangeNothing) {
    Driver driver = made_driver();
    CutWorld cut({2049, 2049}, true);
    cut.set("exact");
    for (const Pose pose : {Pose::overview, Pose::low, Pose::grazing}) {
        cut.look(pose);
        view::FrameView frame = cut.selected();
        const HitBuffer hits = test::must(driver.draw_hits(frame)).hits;
        auto& tiles = frame.list.terrains.at(0).search->tiles;
        const auto is_above = [](TreeTile tile, TreeTile other) {
            const int levels = tile.level - other.level;
            return levels > 0 && other.col >> levels == tile.col && other.row >> levels == tile.row;
        };
        const auto all = tiles;
        const auto dropped = std::erase_if(tiles, [&](const auto& tile) {
            return tile != all.front() &&
                   std::any_of(all.begin(), all.end(),
                               [&](const auto& other) { return is_above(tile->id, other->id); });
        });
        const HitBuffer of_drawn = test::must(driver.draw_hits(frame)).hits;
        EXPECT_GT(dropped, 2U);
        int moved = 0;
        for (int row = 0; row < size.y; ++row) {
            for (int col = 0; col < size.x; ++col) {
                const Hit& a = hits(col, row);
                const Hit& b = of_drawn(col, row);
                moved += a.is_sky() != b.is_sky() ||
                                 (!a.is_sky() && glm::distance(a.place(), b.place()) > 0.01)
                             ? 1
                             : 0;
            }
        }
        EXPECT_LE(moved, size.x * size.y / 1000) << static_cast<int>(pose);
    }
}

// Where cones run out or skip a crest, too.
TEST_F(StreamedReliefGlTest, ConesShowNoSkyWhereThereIsGround) {
    Driver driver = made_driver();
    for (const bool is_cut : {false, true}) {
        CutWorld world({257, 257}, is_cut);
        for (const Pose pose : {Pose::overview, Pose::low, Pose::grazing}) {
            world.look(pose);
            world.set("exact");
            const HitBuffer ground = test::must(driver.draw_hits(world.selected())).hits;
            for (const char* const technique : {"cone", "cone:n=4", "cone:relaxed=0,step=4"}) {
                world.set(technique);
                const HitBuffer hits = test::must(driver.draw_hits(world.selected())).hits;
                int holes = 0;
                for (int row = 0; row < size.y; ++row) {
                    for (int col = 0; col < size.x; ++col) {
                        holes += hits(col, row).is_sky() && !ground(col, row).is_sky() ? 1 : 0;
                    }
                }
                EXPECT_EQ(holes, 0) << technique << " " << static_cast<int>(pose) << is_cut;
            }
        }
    }
}

// Rays find the ground however low it is against its width and its height.
TEST_F(StreamedReliefGlTest, FlatReliefHasNoHoles) {
    Driver driver = made_driver();
    for (const bool is_cut : {false, true}) {
        for (const double exaggeration : {1e-5, 1e-6}) {
            CutWorld world({257, 257}, is_cut, exaggeration);
            world.set("exact");
            world.look(Pose::overview);
            const HitBuffer hits = test::must(driver.draw_hits(world.selected())).hits;
            int holes = 0;
            for (int row = 1; row + 1 < size.y; ++row) {
                for (int col = 1; col + 1 < size.x; ++col) {
                    const bool is_between = !hits(col - 1, row).is_sky() &&
                                            !hits(col + 1, row).is_sky() &&
                                            !hits(col, row - 1).is_sky();
                    holes += hits(col, row).is_sky() && is_between ? 1 : 0;
                }
            }
            EXPECT_EQ(holes, 0) << exaggeration << is_cut;
            EXPECT_FALSE(hits(size.x / 2, size.y / 2).is_sky());
        }
    }
}

TEST_F(StreamedReliefGlTest, UnchangedTilesAreNotUploadedAgain) {
    CutWorld cut({257, 257}, true);
    cut.set("exact");
    Driver driver = made_driver();
    const view::FrameView frame = cut.selected();
    test::must(driver.draw(frame));
    const Image first = driver.read_color();
    const view::FrameStats again = test::must(driver.draw(frame));
    EXPECT_LE(again.uploads, 1U); // the frame block
    EXPECT_EQ(driver.read_color(), first);
}

// Its box is 20,000 km high and 128 m wide, and the eye is inside: corners cut at the picture's
// border are rounded.
TEST_F(StreamedReliefGlTest, TallReliefIsSeenUpToThePicturesBorder) {
    constexpr glm::ivec2 picture{1024, 768}; // smaller ones showed no hole
    Driver driver = test::must(Driver::create({.size = picture, .shader_dir = {}}));
    Scene scene;
    Node& terrain =
        test::add_terrain(scene, test::plane_heightfield(test::hills(65, 65, 12.0), {2.0, 2.0}), {},
                          {.placement = {}, .exaggeration = 1e6});
    Camera camera = pose(Pose::low, terrain);
    camera.near = 1e-3;
    scene.add_camera(camera);
    for (const char* const technique : {"exact", "cone"}) {
        terrain.get<scene::TerrainNode>()->material.technique =
            test::must(scene::parse_technique(technique));
        const HitBuffer hits = test::must(driver.draw_hits(view::select(scene, picture))).hits;
        int holes = 0;
        for (int row = 1; row + 1 < picture.y; ++row) {
            const bool is_ground_beside = !hits(picture.x - 2, row - 1).is_sky() &&
                                          !hits(picture.x - 2, row).is_sky() &&
                                          !hits(picture.x - 2, row + 1).is_sky();
            holes += hits(picture.x - 1, row).is_sky() && is_ground_beside ? 1 : 0;
        }
        EXPECT_EQ(holes, 0) << technique;
    }
}

} // namespace
} // namespace reljef::render
