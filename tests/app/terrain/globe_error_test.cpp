// The errors that frames of a streamed globe state, over its poles, its seam and elsewhere.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "engine/session/frame_maker.h"
#include "engine/session/scene_setup.h"
#include "engine/session/terrain_index.h"
#include "engine/truth/streamed_truth.h"
#include "tests/support/process_state.h"
#include "tests/support/release_only.h"
#include "tests/support/temporary_folder.h"
#include "tests/terrain/chance.h"
#include "tests/terrain/made_globe.h"

namespace reljef::app {
namespace {

constexpr glm::ivec2 globe_picture{96, 72};
constexpr double globe_bound = 1.0; // pixels
constexpr std::size_t memory_of_globe_truth = std::size_t{4} << 20U;

/// An ESRI grid of whole metres, and its coordinate system. Its cells are square.
void write(const test::MadeGlobe& globe, const test::TemporaryFolder& folder) {
    constexpr int no_height = -9999;
    std::string text =
        fmt::format("ncols {}\nnrows {}\nxllcenter {:.12f}\nyllcenter {:.12f}\ncellsize {:.15f}\n"
                    "NODATA_value {}\n",
                    globe.cols + (globe.repeats ? 1 : 0), globe.rows, globe.longitude(0),
                    globe.latitude(globe.rows - 1), globe.col_step(), no_height);
    for (int row = 0; row < globe.rows; ++row) {
        for (int col = 0; col < globe.cols + (globe.repeats ? 1 : 0); ++col) {
            const int around = col % globe.cols;
            text += fmt::format("{} ", globe.is_void(around, row)
                                           ? no_height
                                           : static_cast<int>(globe.height(around, row)));
        }
        text += "\n";
    }
    folder.write("globe.asc", text);
    folder.write("globe.prj", "GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\","
                              "6378137,298.257223563]],PRIMEM[\"Greenwich\",0],"
                              "UNIT[\"degree\",0.0174532925199433]]");
}

struct PlacedGlobe {
    test::MadeGlobe globe;
    terrain::PlacementKind placement = terrain::PlacementKind::ellipsoid;
};

class GlobeError : public testing::TestWithParam<PlacedGlobe> {
protected:
    void SetUp() override {
        RELJEF_RELEASE_ONLY("draws dozens of views");
        write(GetParam().globe, folder_);
        choice_.placement = GetParam().placement;
        choice_.terrain = (folder_.path() / "globe.asc").string();
        choice_.memory_megabytes = 2;
        choice_.streamed = true;
        choice_.index = session::IndexUse::made;
    }
    void expect_kept(session::TerrainScene& scene, session::DeviceFrames& frames,
                     truth::StreamedTruth& truth) const;

    test::TemporaryFolder folder_;
    test::EnvironmentVariable cache_{"XDG_CACHE_HOME", (folder_.path() / "cache").string()};
    session::SourceOptions choice_;
    mutable int shown_ = 0; // pixels
};

void GlobeError::expect_kept(session::TerrainScene& scene, session::DeviceFrames& frames,
                             truth::StreamedTruth& truth) const {
    frames.wait_for_tiles(scene.scene, {});
    const auto hits = frames.draw_hits(scene.scene, {});
    ASSERT_TRUE(hits) << hits.error().message;
    const view::FrameStats& stats = frames.frame_stats();
    EXPECT_EQ(stats.tiles_unproven, 0);
    ASSERT_TRUE(stats.kept_error);
    const auto errors = truth.reprojection_errors(scene.scene.camera(), *hits, {});
    ASSERT_TRUE(errors) << errors.error().message;
    const auto exact = truth.draw_hits(scene.scene.camera(), globe_picture, {});
    ASSERT_TRUE(exact) << exact.error().message;
    const bool has_sky = std::any_of(exact->samples().begin(), exact->samples().end(),
                                     [](const Hit& hit) { return hit.is_sky(); });
    int over = 0;
    double worst = 0.0;
    int holes = 0;
    for (std::size_t i = 0; i < errors->size(); ++i) {
        const double error = errors->samples()[i];
        shown_ += std::isnan(error) ? 0 : 1;
        over += !std::isnan(error) && !(error <= *stats.kept_error) ? 1 : 0;
        worst = std::isnan(error) ? worst : std::max(worst, error);
        holes += !has_sky && hits->samples()[i].is_sky() ? 1 : 0;
    }
    EXPECT_EQ(over, 0) << worst << " px found, " << *stats.kept_error << " stated";
    EXPECT_EQ(holes, 0);
}

TEST_P(GlobeError, of_no_pixel_is_more_than_the_frame_states) {
    session::SceneOptions view;
    view.size = globe_picture;
    view.max_error = globe_bound;
    view.geodetic = session::GeodeticView{89.0, 20.0, 400e3, 10.0, -80.0};
    session::Log silent;
    auto scene = session::open_scene(choice_, view, silent, {});
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_NE(scene->terrain->get<scene::TerrainNode>()->stream, nullptr);
    auto device =
        session::Device::create({.context = session::BackendKind::osmesa, .size = globe_picture});
    ASSERT_TRUE(device) << device.error().message;
    session::DeviceFrames frames(std::move(*device), silent, {.memory_megabytes = 2});
    auto truth = truth::StreamedTruth::create(scene->scene, memory_of_globe_truth);
    ASSERT_TRUE(truth) << truth.error().message;
    const terrain::Placement& placement =
        scene->terrain->get<scene::TerrainNode>()->surface->placement();
    test::Chance chance(17);
    const int views = test::cases(6, 12);
    for (int i = 0; i < views; ++i) {
        const double high = GetParam().globe.has_poles ? 90.0 : 60.0;
        const std::array latitudes{high, -high, chance.between(-high, high), chance.between(-5, 5)};
        const std::array longitudes{chance.between(-180.0, 180.0), 180.0, -179.9, 179.9};
        const double latitude = std::clamp(
            latitudes.at(static_cast<std::size_t>(i % 4)) + chance.between(-2.0, 2.0), -high, high);
        const double longitude = longitudes.at(static_cast<std::size_t>(i / 4 % 4));
        const double above = std::exp(chance.between(std::log(4e3), std::log(3e7)));
        SCOPED_TRACE(fmt::format("{},{} from {} m", latitude, longitude, above));
        const auto eye = placement.world_from_geodetic({latitude, longitude, 3500.0 + above});
        const auto target = placement.world_from_geodetic(
            {latitude - std::copysign(0.3 * above / 111e3, latitude) / (1.0 + above / 2e6),
             longitude + 0.1, 0.0});
        ASSERT_TRUE(eye && target);
        scene::Camera& camera = *scene->camera->get<scene::Camera>();
        camera.eye = *eye;
        camera.target = *target;
        camera.up = placement.north(*eye);
        expect_kept(*scene, frames, *truth);
    }
    const bool has_edges = GetParam().placement == terrain::PlacementKind::plane;
    EXPECT_GT(shown_, views * globe_picture.x * globe_picture.y / (has_edges ? 4 : 2));
}

INSTANTIATE_TEST_SUITE_P(
    Globes, GlobeError,
    testing::Values(
        PlacedGlobe{{.cols = 700, .rows = 350}},
        PlacedGlobe{{.cols = 640, .rows = 321, .on_lines = true}},
        PlacedGlobe{{.cols = 640, .rows = 321, .on_lines = true, .repeats = true}},
        PlacedGlobe{{.cols = 648, .rows = 270, .has_poles = false}},
        PlacedGlobe{{.cols = 700, .rows = 350, .voids = 0.1}},
        PlacedGlobe{{.cols = 640, .rows = 321, .on_lines = true, .voids = 0.3}},
        PlacedGlobe{{.cols = 648, .rows = 270, .has_poles = false, .voids = 0.5}},
        PlacedGlobe{{.cols = 700, .rows = 350}, terrain::PlacementKind::plane},
        PlacedGlobe{{.cols = 700, .rows = 350, .voids = 0.2}, terrain::PlacementKind::plane},
        PlacedGlobe{{.cols = 640, .rows = 321, .on_lines = true}, terrain::PlacementKind::plane}));

} // namespace
} // namespace reljef::app
