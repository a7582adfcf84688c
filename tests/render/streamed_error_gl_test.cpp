#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <set>
#include <vector>

#include "engine/scene/streaming/tile_stream.h"
#include "engine/view/tile_selection.h"
#include "tests/render/driver_fixture.h"
#include "tests/render/made_stream.h"
#include "tests/session/made_session.h"
#include "tests/terrain/chance.h"
#include "tests/terrain/made_tiles.h"

namespace reljef::render {
namespace {

using terrain::TreeTile;

constexpr int ground_samples = 700;
constexpr double ground_reduction = 8.0;

// The rougher the closer one looks: waves of all directions, each 0.7 times as long as the one
// before and not quite as much lower.
Grid<float> rough_ground() {
    struct Wave {
        glm::dvec2 number;
        double height;
    };
    test::Chance chance(8);
    std::vector<Wave> waves;
    for (double length = 600.0; length > 3.0; length *= 0.7) {
        const double turn = chance.between(0.0, 2.0 * std::numbers::pi);
        waves.push_back(
            {2.0 * std::numbers::pi / length * glm::dvec2(std::cos(turn), std::sin(turn)),
             15.0 * std::pow(length / 600.0, 0.8)});
    }
    return test::made_heights(ground_samples, ground_samples, [&](int col, int row) {
        double height = 0.0;
        for (const Wave& wave : waves) {
            height += wave.height * std::sin(glm::dot(wave.number, glm::dvec2(col, row)));
        }
        return height;
    });
}

// Means of the samples within half a step of a place.
float mean_around(const Grid<float>& ground, glm::dvec2 place, int step) {
    const glm::ivec2 first(glm::ceil(place - 0.5 * step));
    double sum = 0.0;
    for (int i = 0; i < step * step; ++i) {
        sum += ground.clamped(first.x + i % step, first.y + i / step);
    }
    return static_cast<float>(sum / (step * step));
}

Grid<float> overview_of(const Grid<float>& ground) {
    const int side = ground_samples / static_cast<int>(ground_reduction);
    return test::made_heights(side, side, [&](int col, int row) {
        const glm::dvec2 middle =
            ground_reduction * glm::dvec2(col, row) + 0.5 * (ground_reduction - 1);
        return mean_around(ground, middle, static_cast<int>(ground_reduction));
    });
}

class StreamedError : public DriverGlTest {
protected:
    void SetUp() override {
        DriverGlTest::SetUp();
        ground_ = std::make_shared<const Grid<float>>(rough_ground());
        terrain_ = &test::add_terrain(
            scene_, test::plane_heightfield(overview_of(*ground_), glm::dvec2(ground_reduction)));
        camera_ = &scene_.add_camera(pose(scene::Pose::overview, *terrain_));
        auto& node = *terrain_->get<scene::TerrainNode>();
        node.material.technique = scene::parse_technique("polygons:error=1").value();
        const terrain::TileTree tree(ground_samples, ground_samples);
        const auto read = [ground = ground_, tree](TreeTile tile, const std::stop_token&) {
            scene::TileContent reading;
            reading.heights = test::tile_heights(tree.cells(tile), [&](glm::ivec2 vertex) {
                return mean_around(*ground, glm::dvec2(tree.sample(tile, vertex)),
                                   terrain::TileTree::step(tile));
            });
            return reading;
        };
        node.stream = std::make_shared<scene::TileStream>(
            scene::TileBuilder(node.surface, tree, static_cast<int>(ground_reduction)), read,
            scene::TileStreamOptions{.memory_budget = 300 * scene::bytes_per_tile, .threads = 2});
    }

    void bring() { bring_tiles(scene_); }

    // Of the pixels that show terrain, pixels.
    std::vector<double> errors(const HitBuffer& hits) const {
        const auto& node = *terrain_->get<scene::TerrainNode>();
        std::vector<double> errors;
        for (int row = 0; row < hits.rows(); ++row) {
            for (int col = 0; col < hits.cols(); ++col) {
                const Hit& hit = hits(col, row);
                if (hit.col >= 0.0F) {
                    const glm::dvec2 sample(hit.col, hit.row);
                    const double height = terrain::bilinear_height(ground_->view(), sample);
                    const glm::dvec2 placed = node.stream->maker().on_overview(sample);
                    const auto shown = scene::project(
                        scene_.camera(), size,
                        node.surface->placement().world_from_sample({placed, height}));
                    errors.push_back(glm::distance(shown.pixel, glm::dvec2(col, row) + 0.5));
                }
            }
        }
        return errors;
    }

    std::shared_ptr<const Grid<float>> ground_;
    Scene scene_;
    Node* terrain_ = nullptr;
    Node* camera_ = nullptr;
};

TEST_F(StreamedError, OfRoughGroundIsWhatWasAskedForOrLess) {
    session::SceneRenderer made = driver();
    test::Chance chance(9);
    for (int round = 0; round < 3; ++round) {
        const glm::dvec3 eye(chance.between(-300, 300), chance.between(-300, 300),
                             chance.between(80, 600));
        *camera_->get<Camera>() =
            camera_at(eye, {chance.between(-300, 300), chance.between(-300, 300), 0.0});
        bring();
        const view::FrameStats stats = test::must(made.draw(scene_));
        EXPECT_LT(4 * stats.triangles, 2U * 64U * 64U * static_cast<std::size_t>(stats.tiles));
        const std::vector<double> found = errors(test::must(made.draw_hits(scene_)));
        ASSERT_GT(found.size(), 1000U);
        EXPECT_LE(*std::max_element(found.begin(), found.end()), 1.0) << round;
    }
}

} // namespace
} // namespace reljef::render
