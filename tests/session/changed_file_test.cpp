// Files that get other content of the same size while a stream reads them.
#include <array>
#include <chrono>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/session/streaming.h"
#include "tests/session/made_session.h"
#include "tests/session/streamed_cells.h"
#include "tests/support/process_state.h"

namespace reljef {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr terrain::TreeTile seen_tile{0, 5, 5}; // of N45E006.hgt
constexpr terrain::TreeTile next_tile{0, 6, 5};

class ChangedFile : public test::Streaming {
protected:
    void SetUp() override {
        Streaming::SetUp();
        cache_.emplace("XDG_CACHE_HOME", path("cache"));
    }
    scene::TileStream& open(const session::SourceOptions& choice) {
        auto source = test::open_terrain(choice);
        EXPECT_TRUE(source) << source.error().message;
        auto made = test::make_scene(std::move(*source), choice, {});
        EXPECT_TRUE(made) << made.error().message;
        scene_.emplace(std::move(*made));
        return *scene_->terrain->get<scene::TerrainNode>()->stream;
    }
    /// Now the time of a file differs from any before, however coarse the file system's clock is.
    void touch_later(const std::string& name) {
        later_ += std::chrono::hours(1);
        fs::last_write_time(path(name), fs::file_time_type::clock::now() + later_);
    }

    std::optional<session::TerrainScene> scene_;
    std::optional<test::EnvironmentVariable> cache_;
    std::chrono::hours later_{0};
};

void load_tiles(scene::TileStream& stream, std::span<const terrain::TreeTile> missing,
                std::span<const terrain::TreeTile> used) {
    stream.request(missing, used);
    ASSERT_TRUE(stream.wait({}));
}

TEST_F(ChangedFile, IsToldOnceAndItsTilesAreReadAgain) {
    scene::TileStream& stream = open(streamed_choice());
    load_tiles(stream, std::array{seen_tile}, {});
    const auto before = stream.find(seen_tile);
    ASSERT_NE(before, nullptr);
    for (const int raise : {100, 200}) {
        write_cell("N45E006.hgt", 6, 45, raise);
        touch_later("tiles/N45E006.hgt");
        const terrain::TreeTile other{0, 6, raise / 100};
        load_tiles(stream, std::array{other}, std::array{seen_tile});
        EXPECT_TRUE(stream.has_outdated());
        load_tiles(stream, {}, std::array{seen_tile, other});
        EXPECT_FALSE(stream.has_outdated());
        const auto& now = stream.find(seen_tile)->heightfield.heights;
        const auto& then = before->heightfield.heights;
        for (std::size_t i = 0; i < now.size(); ++i) {
            ASSERT_FLOAT_EQ(now.samples()[i], then.samples()[i] + static_cast<float>(raise));
        }
        EXPECT_THAT(stream.take_errors(), IsEmpty());
        const auto notes = stream.take_notes();
        if (raise == 100) {
            EXPECT_THAT(notes, ElementsAre(HasSubstr("N45E006.hgt: changed while open: its tiles "
                                                     "are read again")));
        } else {
            EXPECT_THAT(notes, IsEmpty()) << "it is told once";
        }
    }
}

TEST_F(ChangedFile, OfTheSameTimeAndSizeIsTheSameFile) {
    scene::TileStream& stream = open(streamed_choice());
    load_tiles(stream, std::array{seen_tile}, {});
    const fs::path cell = path("tiles/N45E006.hgt");
    const auto time = fs::last_write_time(cell);
    fs::rename(cell, path("away"));
    fs::copy_file(path("away"), cell);
    fs::last_write_time(cell, time);
    load_tiles(stream, std::array{next_tile}, std::array{seen_tile});
    EXPECT_FALSE(stream.has_outdated());
    EXPECT_THAT(stream.take_notes(), IsEmpty());
}

// A frame that waits for its tiles shows none from before the change that its reading found.
TEST_F(ChangedFile, IsWaitedForByAFrame) {
    const scene::TileStream& stream = open(streamed_choice());
    scene::Camera& camera = *scene_->camera->get<scene::Camera>();
    const glm::dvec3 centre = scene_->bounds.center();
    const glm::dvec3 size = scene_->bounds.size();
    const auto look_at = [&](double east) {
        camera.eye = centre + glm::dvec3(east * size.x, 0.3 * size.y, 0.5 * size.z + 2000.0);
        camera.target = camera.eye + glm::dvec3(1.0, 1.0, -3000.0);
    };
    session::Log log;
    view::FrameSelector selector;
    const auto wait = [&] { session::wait_for_tiles(scene_->scene, {64, 48}, selector, log, {}); };
    look_at(-0.35);
    wait();
    write_cell("N45E006.hgt", 6, 45, 100);
    touch_later("tiles/N45E006.hgt");
    look_at(-0.25);
    wait();
    EXPECT_FALSE(stream.has_outdated());
}

} // namespace
} // namespace reljef
