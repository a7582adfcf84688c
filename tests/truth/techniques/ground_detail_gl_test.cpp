// A tile of detail that repeats over a terrain, against the same tile on a mesh of the same shape.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "tests/session/made_session.h"
#include "tests/support/release_only.h"
#include "tests/terrain/made_heightfield.h"
#include "tests/truth/techniques/tile_panel.h"

namespace reljef::truth {
namespace {

constexpr double ground_side = 6.0; // metres, as plane_side
constexpr int ground_samples = 61;
constexpr glm::ivec2 ground_picture{160, 120};
constexpr double tile_side = 1.5; // four tiles a side: both begin one at the middle
constexpr float tile_scale = 0.1F;

// Two colours, so that places are told apart, over a terrain whose colour is their mean.
constexpr Rgba8 bright{200, 160, 90, 255};
constexpr Rgba8 dark{90, 120, 160, 255};

std::shared_ptr<const material::ReliefMaterial> checkered_set() {
    material::ReliefMaterial set;
    set.name = "checkered";
    set.heights = wave_tile(32);
    set.color = Image(64, 64);
    for (int row = 0; row < 64; ++row) {
        for (int col = 0; col < 64; ++col) {
            set.color(col, row) = (col / 16 + row / 16) % 2 == 0 ? bright : dark;
        }
    }
    set.scale = tile_scale;
    set.specular = 0.3F;
    return std::make_shared<const material::ReliefMaterial>(
        material::completed(std::move(set), WrapMode::wrap).value());
}

Image mean_color() {
    return Image(2, 2,
                 rgba8_from_linear(0.5F * (linear_from_rgba8(bright) + linear_from_rgba8(dark))));
}

// z metres a sample.
template <class Height> terrain::Heightfield ground_of(const Height& height) {
    return test::plane_heightfield(test::made_heights(ground_samples, ground_samples, height),
                                   glm::dvec2(ground_side / (ground_samples - 1)));
}

std::shared_ptr<const scene::TerrainDetail>
detail_of(const std::string& technique, std::shared_ptr<const material::ReliefMaterial> set,
          double width = tile_side) {
    scene::TerrainDetail detail;
    detail.set = std::move(set);
    detail.width = width;
    detail.scale = tile_scale;
    detail.technique = scene::parse_technique(technique).value();
    return std::make_shared<const scene::TerrainDetail>(std::move(detail));
}

// Grounds that share one compile each program once.
std::shared_ptr<session::SceneRenderer> ground_driver() {
    return std::make_shared<session::SceneRenderer>(
        test::must(test::make_renderer(ground_picture)));
}

// A terrain with a sun, and a camera.
struct Ground {
    scene::Scene scene;
    scene::Node* node = nullptr;
    scene::Node* camera = nullptr;
    std::shared_ptr<session::SceneRenderer> driver;

    explicit Ground(terrain::Heightfield heightfield,
                    std::shared_ptr<session::SceneRenderer> shared = ground_driver())
        : driver(std::move(shared)) {
        node = &test::add_terrain(scene, std::move(heightfield), mean_color());
        scene.add_light();
        camera = &scene.add_camera({});
    }
    void look(glm::dvec3 eye, glm::dvec3 at) const {
        *camera->get<scene::Camera>() = test::camera_at(eye, at);
    }
    scene::TerrainNode& terrain() const { return *node->get<scene::TerrainNode>(); }
    Image picture() {
        test::must(driver->draw(scene));
        return driver->read_color();
    }
    HitBuffer hits() { return test::must(driver->draw_hits(scene)); }
};

// The same tile on a plane of the same extent; `place` moves it to where the terrain is.
Image picture_of_mesh(Ground& ground, const std::string& technique, glm::dvec2 extent,
                      const glm::dmat4& place) {
    scene::Scene scene;
    scene::Material material;
    material.technique = scene::parse_technique(technique).value();
    material.detail.set = checkered_set();
    material.detail.repeats = glm::vec2(ground_side / tile_side);
    // Over tiles that a slope makes longer, the same metres are less of their width.
    const double longer = extent.x * extent.y / (ground_side * ground_side);
    material.detail.scale = static_cast<float>(tile_scale / std::sqrt(longer));
    scene.add_mesh(scene::plane_mesh(glm::vec2(extent)), material).set_parent_from_local(place);
    scene.add_light();
    scene.add_camera(ground.scene.camera());
    test::must(ground.driver->draw(scene));
    return ground.driver->read_color();
}

int difference(Rgba8 one, Rgba8 other) {
    return std::max(
        {std::abs(one.r - other.r), std::abs(one.g - other.g), std::abs(one.b - other.b)});
}

// Share of the pixels that differ by more than `limit` of 255.
double share_over(const Image& one, const Image& other, int limit) {
    int over = 0;
    for (std::size_t i = 0; i < one.size(); ++i) {
        over += difference(one.samples()[i], other.samples()[i]) > limit ? 1 : 0;
    }
    return static_cast<double>(over) / static_cast<double>(one.size());
}

class GroundDetailGlTest : public test::GlTest {};

TEST_F(GroundDetailGlTest, OnALevelTerrainEveryTechniqueShowsWhatItShowsOnAPlane) {
    RELJEF_RELEASE_ONLY("its shaders are drawn with by the other tests");
    Ground ground(ground_of([](int, int) { return 0.0; }));
    ground.look({0.2, -1.6, 1.3}, {0.1, 0.2, 0.0}); // no border in sight
    for (const std::string technique :
         {"bump", "relief:n=16,k=6,steps=8..24,shadow=soft,0.3", "exact:shadow=hard"}) {
        ground.terrain().detail = detail_of(technique, checkered_set());
        const Image mesh =
            picture_of_mesh(ground, technique, glm::dvec2(ground_side), glm::dmat4(1.0));
        EXPECT_LT(share_over(ground.picture(), mesh, 4), 0.002) << technique;
    }
}

// The frame that follows from the heights' gradient is the one of a mesh whose texture coordinates
// grow the same way.
TEST_F(GroundDetailGlTest, OnASlopeTheFrameFollowsTheGradient) {
    RELJEF_RELEASE_ONLY("its shaders are drawn with by the other tests");
    const auto driver = ground_driver();
    for (const double slope : {-0.6, 0.3}) {
        for (const bool to_east : {slope < 0.0}) {
            const double step = slope * ground_side / (ground_samples - 1);
            Ground ground(ground_of([&](int col, int row) {
                              return step * (to_east ? col - (ground_samples - 1) / 2
                                                     : (ground_samples - 1) / 2 - row);
                          }),
                          driver);
            ground.look({0.2, -1.2, 1.9}, {0.1, 0.1, 0.0});
            ground.terrain().detail = detail_of("exact", checkered_set());
            const double angle = std::atan(slope);
            const double length = ground_side / std::cos(angle);
            const glm::dvec2 extent =
                to_east ? glm::dvec2(length, ground_side) : glm::dvec2(ground_side, length);
            const glm::dmat4 place =
                to_east ? glm::rotate(glm::dmat4(1.0), -angle, glm::dvec3(0.0, 1.0, 0.0))
                        : glm::rotate(glm::dmat4(1.0), angle, glm::dvec3(1.0, 0.0, 0.0));
            const Image mesh = picture_of_mesh(ground, "exact", extent, place);
            EXPECT_LT(share_over(ground.picture(), mesh, 4), 0.01) << slope << ' ' << to_east;
        }
    }
}

TEST_F(GroundDetailGlTest, HitsAreTheTerrainsOwn) {
    Ground ground(
        ground_of([](int col, int row) { return 0.3 * std::sin(0.2 * col + 0.1 * row); }));
    ground.look({0.2, -3.0, 1.5}, {0.1, 0.2, 0.0});
    const HitBuffer plain = ground.hits();
    ground.terrain().detail = detail_of("relief", checkered_set());
    const HitBuffer detailed = ground.hits();
    for (std::size_t i = 0; i < plain.size(); ++i) {
        const Hit& one = plain.samples()[i];
        const Hit& other = detailed.samples()[i];
        ASSERT_TRUE(one.col == other.col && one.row == other.row && one.height == other.height &&
                    one.depth == other.depth);
    }
}

TEST_F(GroundDetailGlTest, TooFarToBeSeenItChangesNoBit) {
    Ground ground(
        ground_of([](int col, int row) { return 0.3 * std::sin(0.2 * col + 0.1 * row); }));
    ground.look({1.0, -8.0, 5.0}, {0.0, 0.0, 0.0});
    const Image plain = ground.picture();
    ground.terrain().detail = detail_of("relief", checkered_set(), 0.1);
    EXPECT_EQ(ground.picture(), plain);
    ground.terrain().detail = detail_of("relief", checkered_set(), 1.0);
    EXPECT_NE(ground.picture(), plain);
    ground.terrain().material.technique = scene::make_technique(scene::TechniqueId::relief);
    const Image relief = ground.picture();
    ground.terrain().detail = nullptr;
    EXPECT_EQ(ground.picture(), relief) << "it lies on polygons alone";
}

// From where heights of less than a pixel are looked for on, there is no step in the picture.
TEST_F(GroundDetailGlTest, HeightsFadeInWithoutAStep) {
    Ground ground(ground_of([](int, int) { return 0.0; }));
    const double pixel = 2.0 * std::tan(0.5 * 57.3 * std::acos(-1.0) / 180.0) / ground_picture.y;
    const auto seen_from = [&](double height_pixels, const std::string& technique) {
        const double away = tile_scale * tile_side / (pixel * height_pixels);
        ground.look({0.0, -0.5 * away, 0.9 * away}, {0.0, 0.0, 0.0});
        ground.terrain().detail = detail_of(technique, checkered_set());
        return ground.picture();
    };
    EXPECT_EQ(share_over(seen_from(0.8, "exact"), seen_from(0.8, "normal"), 0), 0.0);
    const double just_there = share_over(seen_from(1.1, "exact"), seen_from(1.1, "normal"), 12);
    const double all_there = share_over(seen_from(2.5, "exact"), seen_from(2.5, "normal"), 12);
    EXPECT_LT(just_there, 0.02);
    EXPECT_GT(all_there, 0.03);
}

// Blocks that stand far apart, a pixel or less of them.
std::shared_ptr<const material::ReliefMaterial> blocky_set() {
    material::ReliefMaterial set;
    set.name = "blocky";
    set.heights = Grid<float>(128, 128, 0.0F);
    for (int row = 0; row < 128; ++row) {
        for (int col = 0; col < 128; ++col) {
            set.heights(col, row) = col % 16 < 3 && row % 16 < 3 ? 1.0F : 0.0F;
        }
    }
    set.color = Image(2, 2, bright);
    set.scale = tile_scale;
    return std::make_shared<const material::ReliefMaterial>(
        material::completed(std::move(set), WrapMode::wrap).value());
}

// Means of `side` times `side` pixels, linear.
Grid<glm::vec3> means_of(const Image& picture, int side) {
    Grid<glm::vec3> means(picture.cols() / side, picture.rows() / side, glm::vec3(0.0F));
    for (int row = 0; row < means.rows() * side; ++row) {
        for (int col = 0; col < means.cols() * side; ++col) {
            means(col / side, row / side) +=
                glm::vec3(linear_from_rgba8(picture(col, row))) / static_cast<float>(side * side);
        }
    }
    return means;
}

// Shadows that are thinner than a pixel make it darker by as much as they cover, none black.
TEST_F(GroundDetailGlTest, FarShadowsAreSeenAsTheirMean) {
    RELJEF_RELEASE_ONLY("it is what a shader says");
    Ground ground(ground_of([](int, int) { return 0.0; }));
    ground.look({0.2, -2.9, 1.6}, {0.1, 0.6, 0.0});
    ground.terrain().detail = detail_of("exact:shadow=hard", blocky_set());
    const glm::ivec2 small(80, 60);
    constexpr int finer = 4;
    ASSERT_TRUE(ground.driver->resize(small));
    const Grid<glm::vec3> seen = means_of(ground.picture(), 1);
    ASSERT_TRUE(ground.driver->resize(finer * small));
    const Grid<glm::vec3> truth = means_of(ground.picture(), finer);
    double squares = 0.0;
    double sum = 0.0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const double error = static_cast<double>(seen.samples()[i].g - truth.samples()[i].g);
        squares += error * error;
        sum += error;
    }
    const auto count = static_cast<double>(seen.size());
    EXPECT_LT(std::sqrt(squares / count), 0.055); // 0.051; 0.073 where each pixel asks one place
    EXPECT_NEAR(sum / count, 0.0, 0.03);
}

// Whatever divides by nothing on the way makes a pixel black: the sky lights all that is there.
TEST_F(GroundDetailGlTest, DegenerateTerrainsStayFinite) {
    std::vector<terrain::Heightfield> fields;
    fields.push_back(test::plane_heightfield(Grid<float>(2, 2, 0.0F), {5.0, 5.0}));
    fields.push_back(ground_of([](int, int) { return 1e4; }));
    fields.push_back(ground_of([](int col, int row) { return (col / 7 + row / 9) % 2 * 1e5; }));
    fields.push_back(ground_of([](int col, int) { return col < 30 ? 0.0 : -1e5; }));
    const auto driver = ground_driver();
    for (std::size_t i = 0; i < fields.size(); ++i) {
        Ground ground(std::move(fields[i]), driver);
        const double top = ground.scene.root().world_bounds().high.z;
        ground.look({-1.0, -1.2, top + 1.0}, {0.4, 0.8, top});
        for (const std::string technique : {"exact:shadow=hard"}) {
            ground.terrain().detail = detail_of(technique, checkered_set());
            const Image picture = ground.picture();
            const HitBuffer hits = ground.hits();
            for (std::size_t k = 0; k < picture.size(); ++k) {
                const Rgba8 shown = picture.samples()[k];
                ASSERT_TRUE(hits.samples()[k].is_sky() || shown.r + shown.g + shown.b > 0)
                    << i << ' ' << technique;
            }
        }
    }
}

// Walls carry the tile upright instead of stretched.
TEST_F(GroundDetailGlTest, ATileOnAWallIsAsLargeAsOnTheGround) {
    Ground ground(ground_of([](int, int row) { return row < 30 ? 300.0 : 0.0; })); // looks south
    ground.look({0.0, -2.5, 150.0}, {0.0, 0.0, 150.0});
    ground.terrain().detail = detail_of("texture", checkered_set());
    const Image picture = ground.picture();
    const auto changes = [&](glm::ivec2 step) {
        int count = 0;
        glm::ivec2 at(ground_picture / 2 - 50 * step);
        for (int i = 0; i < 100; ++i, at += step) {
            count += difference(picture(at.x, at.y), picture(at.x + step.x, at.y + step.y)) > 10;
        }
        return count;
    };
    EXPECT_GT(changes({1, 0}), 1);
    EXPECT_NEAR(changes({0, 1}), changes({1, 0}), 1);
}

} // namespace
} // namespace reljef::truth
