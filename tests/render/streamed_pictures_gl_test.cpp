#include <array>
#include <cmath>

#include "engine/core/bilinear.h"
#include "engine/scene/streaming/tile_stream.h"
#include "engine/view/tile_selection.h"
#include "engine/view/triangles/tile_cut.h"
#include "tests/render/driver_fixture.h"
#include "tests/render/made_stream.h"
#include "tests/session/made_session.h"
#include "tests/terrain/made_tiles.h"

namespace reljef::render {
namespace {

using terrain::TreeTile;

constexpr int samples = 257; // of the terrain, a metre apart
constexpr int overview_reduction = 8;
constexpr int refinement = 4;
constexpr int tree_side = (samples - 1) * refinement + 1;

double hill(glm::dvec2 sample) {
    return 6.0 * std::sin(0.07 * sample.x) * std::cos(0.05 * sample.y);
}

/// What the images show at a sample of the terrain.
glm::dvec3 shown_at(glm::dvec2 sample) {
    return {127.5 + 60.0 * std::sin(0.5 * sample.x), 127.5 + 60.0 * std::cos(0.4 * sample.y), 60.0};
}
// Of a colour, levels a square sample: 60 · 0.5², and as much again since it is linear light that
// filters mix, which bends by 1.2 over a level of at least 67 where a colour grows by 30 a sample.
constexpr double max_bend = 60.0 * 0.5 * 0.5 + 1.2 / 67.0 * 30.0 * 30.0;

/// The same in stripes, as wide as two pixels.
glm::dvec3 striped_at(glm::dvec2 sample) {
    return glm::dvec3(static_cast<int>(std::floor(4.0 * sample.x)) % 2 == 0 ? 150.0 : 90.0);
}

/// West of the middle there are images, in pixels of an eighth of a metre.
class Pictures {
public:
    using Show = glm::dvec3 (*)(glm::dvec2);

    explicit Pictures(std::size_t memory_budget = std::size_t{400} << 20U, Show show = shown_at) {
        auto heightfield =
            test::plane_heightfield(test::overview_heights(samples, overview_reduction, hill),
                                    glm::dvec2(static_cast<double>(overview_reduction)));
        terrain = &test::add_terrain(scene, std::move(heightfield));
        camera = &scene.add_camera(pose(scene::Pose::overview, *terrain));
        auto& node = *terrain->get<scene::TerrainNode>();
        const scene::TileBuilder maker(
            node.surface, terrain::TileTree(tree_side, tree_side), overview_reduction,
            {.finest_pixel = 0.125,
             .refinement = refinement,
             .max_texels = scene::TileStream::texels_within(memory_budget)});
        stream = std::make_shared<scene::TileStream>(
            maker,
            [maker, show](TreeTile tile, const std::stop_token&) {
                return read(maker, tile, show);
            },
            scene::TileStreamOptions{.memory_budget = memory_budget, .threads = 2});
        node.stream = stream;
    }
    void look_down(glm::dvec3 eye) {
        *camera->get<Camera>() = camera_at(eye, {eye.x + 0.01, eye.y, 0.0});
        bring_tiles(scene);
    }

    Scene scene;
    Node* terrain = nullptr;
    Node* camera = nullptr;
    std::shared_ptr<scene::TileStream> stream;

private:
    static scene::TileContent read(const scene::TileBuilder& maker, TreeTile tile, Show show) {
        scene::TileContent reading;
        reading.heights = test::tile_heights(maker.tree().cells(tile), [&](glm::ivec2 vertex) {
            return hill(maker.sample(tile, vertex));
        });
        const glm::ivec2 texels = maker.picture_size(tile);
        const glm::dvec2 cells(maker.tree().cells(tile));
        reading.picture.texels = Image(texels.x, texels.y, Rgba8{0, 0, 0, 0});
        reading.picture.has_more = maker.texel(tile.level) > 0.126;
        for (int row = 0; row < texels.y; ++row) {
            for (int col = 0; col < texels.x; ++col) {
                const glm::dvec2 sample = maker.first(tile) + maker.step(tile) *
                                                                  glm::dvec2(col, row) * cells /
                                                                  glm::dvec2(texels - 1);
                const glm::ivec3 color(glm::round(show(sample)));
                if (sample.x <= 0.5 * samples) {
                    reading.picture.texels(col, row) = {static_cast<std::uint8_t>(color.r),
                                                        static_cast<std::uint8_t>(color.g),
                                                        static_cast<std::uint8_t>(color.b), 255};
                }
            }
        }
        return reading;
    }
};

class StreamedPicturesGlTest : public DriverGlTest {};

// Texels, a pixel at most, are linear between their middles, as those of the next mipmap are: an
// eighth of the square of two pixels, half as wide again on slopes, times the bend. And colours are
// rounded four times.
TEST_F(StreamedPicturesGlTest, EveryPixelHasTheColourOfItsPlace) {
    Pictures world;
    session::SceneRenderer made = driver();
    for (const glm::dvec3 eye : {glm::dvec3(-60.0, 20.0, 25.0), {-70.0, -30.0, 40.0}}) {
        world.look_down(eye);
        test::must(made.draw(world.scene));
        const Image picture = made.read_color();
        const HitBuffer hits = test::must(made.draw_hits(world.scene));
        const double pixel = 2.0 * eye.z * std::tan(glm::radians(0.5 * 57.3)) / size.y;
        const double allowed = max_bend * 9.0 * pixel * pixel / 8.0 + 2.0;
        int compared = 0;
        for (int row = 0; row < size.y; ++row) {
            for (int col = 0; col < size.x; ++col) {
                const Hit hit = hits(col, row);
                if (hit.col < 0.0F || hit.col > 0.5F * samples - 1.0F) {
                    continue;
                }
                const glm::dvec3 expected = shown_at({hit.col, hit.row});
                const Rgba8 found = picture(col, row);
                ASSERT_NEAR(found.r, expected.r, allowed) << col << "," << row;
                ASSERT_NEAR(found.g, expected.g, allowed) << col << "," << row;
                ASSERT_NEAR(found.b, expected.b, 2.0) << col << "," << row;
                ++compared;
            }
        }
        EXPECT_GT(compared, 20000);
    }
}

// Level and of two colours, one beside the other from west to east, six metres wide.
std::shared_ptr<const scene::TerrainDetail> two_colours(Rgba8 west, Rgba8 east) {
    material::ReliefMaterial set;
    set.name = "two colours";
    set.heights = Grid<float>(16, 16, 1.0F);
    set.color = Image(16, 16, west);
    set.specular = 0.0F;
    for (int row = 0; row < 16; ++row) {
        for (int col = 8; col < 16; ++col) {
            set.color(col, row) = east;
        }
    }
    scene::TerrainDetail detail;
    detail.set = std::make_shared<const material::ReliefMaterial>(
        material::completed(std::move(set), material::WrapMode::wrap).value());
    detail.width = 6.0;
    detail.technique = scene::parse_technique("exact:shadow=hard").value();
    return std::make_shared<const scene::TerrainDetail>(std::move(detail));
}

// The light of a pixel with it over that of the same one without is that of its place on the tile
// over the tile's mean, whatever the images show there: stripes narrower than the vertices'
// distance are as sharp.
TEST_F(StreamedPicturesGlTest, ATileOfDetailKeepsInSunlightWhatImagesShow) {
    Pictures world(std::size_t{400} << 20U, striped_at);
    world.scene.add_light();
    world.look_down({-70.0, -30.0, 25.0});
    session::SceneRenderer made = driver();
    const auto picture = [&](std::shared_ptr<const scene::TerrainDetail> detail) {
        world.terrain->get<scene::TerrainNode>()->detail = std::move(detail);
        test::must(made.draw(world.scene));
        return made.read_color();
    };
    const Image plain = picture(nullptr);
    constexpr std::array<Rgba8, 2> colors{Rgba8{180, 180, 180, 255}, Rgba8{130, 130, 130, 255}};
    const std::array lights{linear_from_rgba8(colors[0]).g, linear_from_rgba8(colors[1]).g};
    const Image detailed = picture(two_colours(colors[0], colors[1]));
    const HitBuffer hits = test::must(made.draw_hits(world.scene));
    const scene::TileBuilder& maker = world.stream->maker();
    int compared = 0;
    int worst = 0;
    int striped = 0;
    for (int row = 0; row < size.y; ++row) {
        for (int col = 0; col < size.x; ++col) {
            const Hit hit = hits(col, row);
            const double x = maker.overview()
                                 .placement()
                                 .world_from_sample({maker.on_overview({hit.col, hit.row}), 0.0})
                                 .x;
            const double along = glm::fract(x / 6.0);
            if (hit.col < 1.0F || hit.col > 0.5F * samples - 1.0F ||
                std::abs(glm::fract(2.0 * along + 0.5) - 0.5) < 0.1) {
                continue; // its border, where colours are mixed
            }
            const float share = lights.at(along < 0.5 ? 0 : 1) / (0.5F * (lights[0] + lights[1]));
            const Rgba8 expected = rgba8_from_linear(linear_from_rgba8(plain(col, row)) * share);
            worst = std::max(worst, std::abs(detailed(col, row).g - expected.g));
            ++compared;
            const int beside = plain(col, std::min(row + 2, size.y - 1)).g; // a stripe farther
            striped += std::abs(plain(col, row).g - beside) > 20 ? 1 : 0;
        }
    }
    EXPECT_GT(compared, 20000);
    EXPECT_LE(worst, 3);
    EXPECT_GT(striped, compared / 3);
}

TEST_F(StreamedPicturesGlTest, WhereImagesAreFinerFinerTilesAreDrawn) {
    Pictures world;
    const auto finest_level = [&](glm::dvec3 eye) {
        world.look_down(eye);
        int level = 99;
        for (const auto& drawn : view::select_tiles(*world.terrain->get<scene::TerrainNode>(),
                                                    world.scene.camera(), size, glm::dmat4(1.0))
                                     .drawn) {
            level = std::min(level, drawn.tile->id.level);
        }
        return level;
    };
    EXPECT_LE(finest_level({-80.0, 0.0, 12.0}), 1);
    EXPECT_EQ(finest_level({-80.0, 0.0, 80.0}), 2); // that of all samples: a texel of 0.25 m
}

TEST_F(StreamedPicturesGlTest, AFlightOverImagesStaysWithinALittleMemory) {
    constexpr std::size_t budget = std::size_t{64} << 20U;
    Pictures world(budget);
    for (int step = 0; step < 12; ++step) {
        world.look_down({-110.0 + 10.0 * step, 8.0 * step - 50.0, 8.0});
    }
    EXPECT_GE(world.stream->stats().read, 16);
    EXPECT_LE(world.stream->stats().max_bytes, budget);
}

TEST(StreamedVertices, StandWhereADoubleOracleHasThemSeenFromAMetre) {
    // Level 0 of samples 90 m apart: tiles 12 km wide, far from the origin.
    constexpr int wide = 2049;
    auto heightfield = test::plane_heightfield(
        test::made_heights(wide / 8, wide / 8, [](int col, int) { return 3.0 * col; }),
        glm::dvec2(720.0));
    Scene scene;
    Node& terrain = test::add_terrain(scene, std::move(heightfield));
    auto& node = *terrain.get<scene::TerrainNode>();
    const scene::TileBuilder maker(node.surface, terrain::TileTree(wide, wide), 8);
    const TreeTile id{0, 15, 3};
    const glm::ivec2 count = maker.tree().cells(id) + 3;
    const auto heights = test::made_heights(count.x, count.y, [](int col, int row) {
        return 1000.0 + 700.0 * std::sin(0.37 * col) * std::cos(0.21 * row);
    });
    node.stream = std::make_shared<scene::TileStream>(
        maker, [](TreeTile, const std::stop_token&) { return scene::TileContent{}; });
    view::TileDraw draw;
    draw.terrain = &node;
    draw.tile = std::make_shared<const scene::TerrainTile>(maker.make(id, heights));
    const view::TileSurface surface = view::surface_of(draw);
    const view::GridMesh mesh =
        view::full_mesh(surface.heightfield, surface.placement, surface.samples);
    // Of a picture 768 pixels high, from a metre away.
    const double pixels_per_metre = 0.5 * 768.0 / std::tan(glm::radians(0.5 * 57.3));
    double worst = 0.0;
    for (int row = 0; row <= mesh.rows; ++row) {
        for (int col = 0; col <= mesh.cols; ++col) {
            const view::GridVertex& vertex =
                mesh.vertices[static_cast<std::size_t>(row * (mesh.cols + 1) + col)];
            const glm::dvec3 found = glm::dvec3(vertex.position) + glm::dvec3(vertex.rest);
            const glm::dvec3 expected = maker.place(id, {col, row}, heights(col + 1, row + 1));
            worst = std::max(worst, glm::distance(found, expected) * pixels_per_metre);
        }
    }
    EXPECT_LE(worst, 0.01);
}

} // namespace
} // namespace reljef::render
