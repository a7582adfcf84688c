#include "engine/session/picture/picture_parts.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/image/image.h"
#include "tests/app/made_hill.h"
#include "tests/support/temporary_folder.h"

namespace reljef::session {
namespace {

constexpr glm::ivec2 whole_size{200, 150};
constexpr PictureParts parts{whole_size, {64, 64}}; // the last ones reach beyond the picture

struct PartStage {
    BackendKind backend = BackendKind::cpu;
    int samples = 1;
    TerrainScene scene;
    Costs costs = {};
};

DeviceFrames frames_of(const PartStage& stage, glm::ivec2 size, Log& log) {
    return {std::move(*Device::create({.context = stage.backend,
                                       .size = size,
                                       .samples = stage.samples,
                                       .costs = stage.costs})),
            log};
}

/// Rough ground to the horizon, with sky above.
TerrainScene rough_scene(SceneOptions view) {
    constexpr int side = 129;
    Grid<float> heights(side, side);
    for (int row = 0; row < side; ++row) {
        for (int col = 0; col < side; ++col) {
            heights(col, row) =
                static_cast<float>(90.0 * std::sin(0.37 * col) * std::cos(0.23 * row + 0.1 * col));
        }
    }
    view.size = whole_size;
    return app::scene_of(std::move(heights), std::move(view));
}

SceneOptions with_bound() {
    SceneOptions view;
    view.max_error = 1.0;
    return view;
}

Image in_one_piece(PartStage& stage) {
    Log silent;
    return frames_of(stage, whole_size, silent).draw(stage.scene.scene, {}).value();
}

Image in_parts(PartStage& stage) {
    const test::TemporaryFolder folder;
    Log silent;
    DeviceFrames frames = frames_of(stage, parts.frame(), silent);
    auto file = draw_large_picture({folder.path() / "a.png", parts}, stage.scene, frames, {});
    EXPECT_TRUE(file && file->commit()) << (file ? "" : file.error().message);
    return io::read_image(folder.path() / "a.png").value();
}

struct Differences {
    int pixels = 0;
    int largest = 0;
};

Differences differences(const Image& a, const Image& b) {
    Differences found;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const Rgba8 x = a.samples()[i];
        const Rgba8 y = b.samples()[i];
        const int here = std::max({std::abs(x.r - y.r), std::abs(x.g - y.g), std::abs(x.b - y.b)});
        found.pixels += here > 0 ? 1 : 0;
        found.largest = std::max(found.largest, here);
    }
    return found;
}

TEST(PicturePartsGl, RaysDrawTheSameBitsAsInOnePiece) {
    for (const int samples : {1, 4}) {
        for (const char* const technique : {"exact", "polygons:error=1"}) {
            SceneOptions view;
            view.technique = scene::parse_technique(technique).value();
            PartStage stage{BackendKind::cpu, samples, rough_scene(view)};
            const auto [pixels, largest] = differences(in_one_piece(stage), in_parts(stage));
            EXPECT_EQ(pixels, 0) << technique << ", " << samples << " samples, by " << largest;
        }
    }
}

TEST(PicturePartsGl, RaysDrawTheSameMapAsInOnePiece) {
    SceneOptions view = with_bound();
    view.projection = scene::ProjectionKind::orthographic;
    PartStage stage{BackendKind::cpu, 4, rough_scene(view)};
    EXPECT_EQ(differences(in_one_piece(stage), in_parts(stage)).pixels, 0);
}

// Floats of another projection are rounded otherwise: a vertex may fall to the next of 256 places
// in a pixel, and a pixel at an edge may then show a sample more of one side.
TEST(PicturePartsGl, OpenGlDrawsThePixelsOfOnePiece) {
    for (const char* const technique : {"polygons", "polygons:error=1", "relief"}) {
        SceneOptions view;
        view.technique = scene::parse_technique(technique).value();
        PartStage stage{BackendKind::osmesa, 4, rough_scene(view)};
        const auto [pixels, largest] = differences(in_one_piece(stage), in_parts(stage));
        EXPECT_LE(pixels, whole_size.x * whole_size.y / 1000) << technique << ", by " << largest;
    }
}

TEST(PicturePartsGl, AutoDrawsAllPartsAlike) {
    const auto stage_of = [](const char* technique, const Costs& costs) {
        SceneOptions view;
        view.technique = scene::parse_technique(technique).value();
        return PartStage{BackendKind::osmesa, 4, rough_scene(view), costs};
    };
    const Costs dear_rays{.ray_pixel_ns = 1e9};
    const Costs dear_triangles{.triangle_ns = 1e9, .covered_pixel_ns = 1e6};
    for (const auto& [costs, same] :
         {std::pair{dear_rays, "polygons:error=1"}, std::pair{dear_triangles, "exact"}}) {
        PartStage chosen = stage_of("auto:error=1", costs);
        PartStage expected = stage_of(same, {});
        EXPECT_EQ(differences(in_parts(chosen), in_parts(expected)).pixels, 0) << same;
    }
}

TEST(PicturePartsGl, CountsOfAllPartsAreAdded) {
    PartStage stage{BackendKind::cpu, 1, rough_scene(with_bound())};
    Log silent;
    const test::TemporaryFolder folder;
    DeviceFrames frames = frames_of(stage, parts.frame(), silent);
    std::size_t rays = 0;
    ParallelOptions options;
    options.progress = [&](double) {
        EXPECT_GT(frames.frame_stats().rays, rays);
        rays = frames.frame_stats().rays;
    };
    ASSERT_TRUE(draw_large_picture({folder.path() / "a.png", parts}, stage.scene, frames, options));
    EXPECT_GE(rays, 200U * 150U);
}

TEST(PicturePartsGl, TheCameraIsThatOfBefore) {
    PartStage stage{BackendKind::cpu, 1, rough_scene(with_bound())};
    const scene::Camera before = stage.scene.scene.camera();
    static_cast<void>(in_parts(stage));
    EXPECT_EQ(stage.scene.scene.camera(), before);
}

TEST(PicturePartsGl, AStopIsAnErrorAndLeavesNoFile) {
    PartStage stage{BackendKind::cpu, 1, rough_scene(with_bound())};
    const test::TemporaryFolder folder;
    Log silent;
    DeviceFrames frames = frames_of(stage, parts.frame(), silent);
    std::stop_source source;
    ParallelOptions options;
    options.stop = source.get_token();
    int told = 0;
    options.progress = [&](double fraction) {
        EXPECT_NEAR(fraction, ++told / 12.0, 1e-12); // 4 × 3 parts
        if (told == 5) {
            source.request_stop();
        }
    };
    const auto file =
        draw_large_picture({folder.path() / "a.tif", parts}, stage.scene, frames, options);
    ASSERT_FALSE(file);
    EXPECT_EQ(file.error().message, "interrupted");
    EXPECT_EQ(told, 5);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(PictureParts, TakeAQuarterOfTheMemoryOrAFewRows) {
    for (const glm::ivec2 size : {glm::ivec2{40'000, 30'000}, glm::ivec2{17'000, 100},
                                  glm::ivec2{100, 1'000'000}, glm::ivec2{4097, 4097}}) {
        for (const int megabytes : {64, 512, 8192}) {
            const PictureParts made = parts_of(size, megabytes);
            EXPECT_EQ(made.part % 64, glm::ivec2(0));
            EXPECT_GE(std::min(made.part.x, made.part.y), 64);
            EXPECT_LE(std::max(made.frame().x, made.frame().y), 2048);
            const double rows = 8.0 * size.x * made.part.y;
            const double frame = 32.0 * made.frame().x * made.frame().y;
            EXPECT_TRUE(rows <= 1e6 * megabytes / 8.0 || made.part.y == 64) << megabytes;
            EXPECT_LE(frame, 1e6 * megabytes / 8.0) << megabytes;
        }
    }
}

TEST(PictureParts, AreNeededBeyondWhatEachGpuDraws) {
    EXPECT_FALSE(needs_parts({16'384, 1024}));
    EXPECT_FALSE(needs_parts({4096, 4096}));
    EXPECT_TRUE(needs_parts({16'385, 1}));
    EXPECT_TRUE(needs_parts({4097, 4096}));
}

} // namespace
} // namespace reljef::session
