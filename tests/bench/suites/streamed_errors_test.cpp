#include "bench/suites/streamed_errors.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "engine/io/formats/raster_writer.h"
#include "engine/session/frame_maker.h"
#include "engine/session/scene_setup.h"
#include "tests/support/temporary_folder.h"

namespace reljef::bench {
namespace {

constexpr int reach = 2;

// A ramp of 401 samples a side, streamed in 1 MB, and the hits of its pose oblique.
class StreamedErrors : public testing::Test {
protected:
    void SetUp() override {
        const auto file = folder_.path() / "ramp.tif";
        const auto fill = [](int first_row, GridView<float> heights) {
            for (int row = 0; row < heights.rows(); ++row) {
                for (int col = 0; col < heights.cols(); ++col) {
                    heights(col, row) = static_cast<float>(0.5 * col + 0.25 * (first_row + row));
                }
            }
        };
        ASSERT_TRUE(io::write_heights(file, {401, 401, 10.0, {400'000.0, 5e6}}, fill));
        session::SourceOptions source;
        source.terrain = file.string();
        source.memory_megabytes = 1;
        source.placement = terrain::PlacementKind::plane;
        source.streamed = true;
        session::SceneOptions view;
        view.pose = scene::Pose::oblique;
        view.size = {64, 48};
        scene_.emplace(*session::open_scene(source, view, log_));
        auto device =
            session::Device::create({.context = session::BackendKind::osmesa, .size = view.size});
        session::DeviceFrames frames(std::move(*device), log_);
        frames.wait_for_tiles(scene_->scene, {});
        hits_ = *frames.draw_hits(scene_->scene, {});
    }

    [[nodiscard]] std::size_t holes() const {
        return streamed_holes(scene_->scene, hits_, reach).value();
    }
    // The lowest row that shows sky, in the middle of the picture.
    [[nodiscard]] int horizon() const {
        int row = hits_.rows() - 1;
        while (row > 0 && !hits_(hits_.cols() / 2, row).is_sky()) {
            --row;
        }
        return row;
    }

    session::Log log_;
    test::TemporaryFolder folder_;
    std::optional<session::TerrainScene> scene_;
    HitBuffer hits_;
};

TEST_F(StreamedErrors, FindHolesAwayFromSilhouettes) {
    EXPECT_EQ(holes(), 0U);
    const int col = hits_.cols() / 2;
    const int last_sky = horizon();
    hits_(col, hits_.rows() / 2) = Hit{};
    EXPECT_EQ(holes(), 1U);
    hits_(col, last_sky + 1) = Hit{};
    EXPECT_EQ(holes(), 1U);
}

TEST_F(StreamedErrors, OfAPlaneAreSmall) {
    const auto errors = streamed_errors(scene_->scene, hits_, 1);
    ASSERT_TRUE(errors);
    ASSERT_GT(errors->size(), 500U);
    EXPECT_LT(*std::max_element(errors->begin(), errors->end()), 0.1);
}

} // namespace
} // namespace reljef::bench
