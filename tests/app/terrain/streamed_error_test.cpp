#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/scene/streaming/tile_stream.h"
#include "engine/session/frame_maker.h"
#include "engine/session/scene_setup.h"
#include "engine/session/streaming.h"
#include "engine/session/terrain_index.h"
#include "engine/terrain/field/heightfield.h"
#include "tests/support/process_state.h"
#include "tests/support/release_only.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_data.h"

namespace reljef::app {
namespace {

namespace fs = std::filesystem;

constexpr glm::ivec2 picture{384, 288};
constexpr double bound = 0.6; // pixels

struct DrawnView {
    session::GeodeticView from;
    bool keeps_bound = false; ///< with the memory of the test
};

/// The block around Mont Blanc, 2401² samples, much more than the memory.
class StreamedError : public ::testing::TestWithParam<DrawnView> {
protected:
    void SetUp() override {
        RELJEF_RELEASE_ONLY("reads and draws the Alps");
        for (const char* name : {"N44E006.hgt", "N44E007.hgt", "N45E006.hgt", "N45E007.hgt"}) {
            const std::string file = std::string("natural/srtm3/") + name;
            RELJEF_NEED_DATA(file);
            fs::create_symlink(fs::absolute(test::data_path(file)), folder_.path() / name);
        }
        choice_.terrain = folder_.path().string();
        choice_.memory_megabytes = 64;
        choice_.streamed = true;
        choice_.index = session::IndexUse::existing;
    }
    [[nodiscard]] session::TerrainScene scene_from(const session::GeodeticView& from,
                                                   const session::SourceOptions& choice) const {
        session::SceneOptions view;
        view.geodetic = from;
        view.max_error = bound;
        session::Log silent;
        auto scene = session::open_scene(choice, view, silent, {});
        EXPECT_TRUE(scene) << (scene ? "" : scene.error().message);
        return std::move(*scene);
    }

    void expect_stated_errors(session::BackendKind context, const Grid<float>& samples) const;

    test::TemporaryFolder folder_;
    test::EnvironmentVariable cache_{"XDG_CACHE_HOME", (folder_.path() / "cache").string()};
    session::SourceOptions choice_;
};

/// How far from where it belongs each pixel shows its place, pixels.
std::vector<double> errors_of(const session::TerrainScene& scene, const HitBuffer& hits,
                              const Grid<float>& samples) {
    const auto& node = *scene.terrain->get<scene::TerrainNode>();
    std::vector<double> errors;
    for (int row = 0; row < hits.rows(); ++row) {
        for (int col = 0; col < hits.cols(); ++col) {
            if (hits(col, row).is_sky()) {
                continue;
            }
            const glm::dvec2 sample = hits(col, row).place();
            const double height = terrain::bilinear_height(samples.view(), sample);
            const glm::dvec3 place = node.surface->placement().world_from_sample(
                {node.stream->maker().on_overview(sample), height});
            const auto shown = scene::project(scene.scene.camera(), picture, place);
            errors.push_back(glm::distance(shown.pixel, glm::dvec2(col, row) + 0.5));
        }
    }
    return errors;
}

/// What the last frame states, after all its pixels were checked.
double checked_error(session::DeviceFrames& frames, const session::TerrainScene& scene,
                     const Grid<float>& samples) {
    const auto hits = frames.draw_hits(scene.scene, {});
    EXPECT_TRUE(hits) << (hits ? "" : hits.error().message);
    const view::FrameStats& stats = frames.frame_stats();
    EXPECT_EQ(stats.tiles_unproven, 0);
    const std::vector<double> errors = errors_of(scene, *hits, samples);
    EXPECT_GT(errors.size(), 30000U);
    EXPECT_LE(*std::max_element(errors.begin(), errors.end()), stats.kept_error.value_or(0.0));
    return stats.kept_error.value_or(0.0);
}

// Where memory is short, more than the bound is stated, and the memory that keeps it.
void StreamedError::expect_stated_errors(session::BackendKind context,
                                         const Grid<float>& samples) const {
    session::Log silent;
    auto device = session::Device::create({.context = context, .size = picture});
    ASSERT_TRUE(device) << device.error().message;
    session::DeviceFrames frames(std::move(*device), silent,
                                 {.memory_megabytes = choice_.memory_megabytes});
    const session::TerrainScene coarse = scene_from(GetParam().from, choice_);
    ASSERT_NE(coarse.terrain->get<scene::TerrainNode>()->stream, nullptr);
    const double stated = checked_error(frames, coarse, samples);
    const std::vector<std::string> notes = frames.error_notes();
    if (GetParam().keeps_bound) {
        EXPECT_LE(stated, bound);
        EXPECT_TRUE(notes.empty());
        return;
    }
    ASSERT_GT(stated, bound);
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_NE(notes.front().find("keeps it"), std::string::npos) << notes.front();
    const session::MemoryForBound needed = session::memory_for_bound(coarse.scene, picture);
    session::SourceOptions enough = choice_;
    enough.memory_megabytes = static_cast<int>(std::ceil(needed.growth * choice_.memory_megabytes));
    const session::TerrainScene fine = scene_from(GetParam().from, enough);
    if (fine.terrain->get<scene::TerrainNode>()->stream != nullptr) { // else all samples fit
        EXPECT_LE(checked_error(frames, fine, samples), bound);
    }
}

// By triangles, and by rays on the CPU, which draw it on a plane.
TEST_P(StreamedError, of_no_pixel_is_more_than_the_frame_states) {
    const auto source = session::open_heights(choice_, session::HeightUse::of_samples, {});
    ASSERT_TRUE(source) << source.error().message;
    const Grid<double> heights = source->tiles.read(source->tiles.grid(), io::Gaps::holes).heights;
    Grid<float> samples(heights.cols(), heights.rows());
    std::transform(heights.samples().begin(), heights.samples().end(), samples.samples().begin(),
                   [](double height) { return static_cast<float>(height); });
    session::Log silent;
    ASSERT_TRUE(session::index_terrain(choice_, silent, {}));
    for (const auto context : {session::BackendKind::osmesa, session::BackendKind::cpu}) {
        SCOPED_TRACE(session::to_string(context));
        expect_stated_errors(context, samples);
    }
}

constexpr session::GeodeticView to_the_east{45.83, 6.75, 2600.0, 60.0, -12.0};
constexpr session::GeodeticView to_the_south{45.3, 6.9, 4500.0, 200.0, -8.0};

INSTANTIATE_TEST_SUITE_P(Views, StreamedError,
                         ::testing::Values(DrawnView{to_the_east, true},
                                           DrawnView{to_the_south, false}));

} // namespace
} // namespace reljef::app
