// Long flights over files that vanish, return and change, and over a server that lies.
// RELJEF_SOAK_FRAMES=20000 flies that far; by default sixty.

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <random>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/process_memory.h"
#include "engine/session/frame_maker.h"
#include "tests/session/made_session.h"
#include "tests/session/streamed_cells.h"
#include "tests/support/nginx.h"
#include "tests/support/process_state.h"
#include "tests/support/release_only.h"
#include "tests/support/test_program.h"

namespace reljef {
namespace {

namespace fs = std::filesystem;

constexpr glm::ivec2 seen{96, 72};
constexpr int memory_megabytes = 64;

int frames_of_soak() {
    const char* const wanted = std::getenv("RELJEF_SOAK_FRAMES");
    return wanted != nullptr ? std::max(std::atoi(wanted), 60) : 60;
}

/// The errors of files, without the notes on those that changed.
class KeptLog : public session::Log {
public:
    void message(session::MessageKind kind, std::string_view sentence) override {
        all_ += kind == session::MessageKind::note ? "" : std::string(sentence) + "\n";
    }
    [[nodiscard]] const std::string& all() const { return all_; }

private:
    std::string all_;
};

class Soak : public test::Streaming {
protected:
    void SetUp() override {
        Streaming::SetUp();
        for (const auto& [name, west, south] :
             {std::tuple("N45E007.hgt", 7, 45), {"N46E006.hgt", 6, 46}, {"N46E007.hgt", 7, 46}}) {
            write_cell(name, west, south);
        }
        for (const auto& entry : fs::directory_iterator(path("tiles"))) {
            names_.push_back(entry.path().filename().string());
        }
        std::sort(names_.begin(), names_.end());
        fs::copy(path("tiles"), path("whole"));
        cache_.emplace("XDG_CACHE_HOME", path("cache"));
    }

    void open(const std::string& terrain, int megabytes) {
        before_ = process_memory().now;
        session::SourceOptions choice = streamed_choice();
        choice.terrain = terrain;
        choice.memory_megabytes = megabytes;
        session::SceneOptions view;
        view.technique = scene::parse_technique("polygons:error=1").value();
        view.size = seen;
        view.rays = session::RayUse::only;
        auto source = test::open_terrain(choice);
        ASSERT_TRUE(source) << source.error().message;
        auto made = test::make_scene(std::move(*source), choice, view);
        ASSERT_TRUE(made) << made.error().message;
        scene_.emplace(std::move(*made));
        ASSERT_NE(scene_->terrain->get<scene::TerrainNode>()->stream, nullptr);
    }
    session::DeviceFrames frames(bool waits) {
        return {test::must(session::Device::create(
                    {.context = session::BackendKind::cpu, .size = seen, .threads = 1})),
                log_,
                {.memory_megabytes = memory_megabytes, .waits_for_tiles = waits}};
    }
    /// A round over all cells, low enough for tiles of full resolution.
    void look_along(double turn) {
        const Box& bounds = scene_->bounds;
        const glm::dvec3 size = bounds.size();
        const double angle = 2.0 * std::numbers::pi * turn;
        scene::Camera& camera = *scene_->camera->get<scene::Camera>();
        camera.eye = bounds.center() + glm::dvec3(0.35 * size.x * std::cos(angle),
                                                  0.35 * size.y * std::sin(angle), 0.0);
        camera.eye.z = bounds.high.z + 0.01 * size.x;
        camera.target = camera.eye + glm::dvec3(-std::sin(angle) * size.x, std::cos(angle) * size.y,
                                                -0.4 * size.x);
    }

    Image picture_at_rest() {
        look_along(0.0);
        return test::must(frames(true).draw(scene_->scene, {}));
    }
    /// Frames show what is there. `before_frame` gets the number of each.
    void fly(const std::function<void(int)>& before_frame) {
        session::DeviceFrames maker = frames(false);
        const int count = frames_of_soak();
        std::size_t files_at_first = 0;
        std::size_t files_later = 0;
        std::size_t most_memory = 0;
        for (int frame = 0; frame < count; ++frame) {
            before_frame(frame);
            look_along(frame / 100.0);
            ASSERT_TRUE(maker.draw(scene_->scene, {})) << frame;
            session::log_stream_errors(scene_->scene, log_);
            std::this_thread::sleep_for(std::chrono::milliseconds(1)); // tiles arrive meanwhile
            std::size_t& files = frame < count / 4 ? files_at_first : files_later;
            files = std::max(files, test::open_files());
            most_memory = std::max(most_memory, process_memory().now);
        }
        const double beyond_before =
            static_cast<double>(most_memory) - static_cast<double>(before_);
        EXPECT_LE(files_later, files_at_first + 2); // files that are opened for the first time
        EXPECT_LE(beyond_before, 1.1e6 * memory_megabytes);
        const auto stats = session::stream_stats(scene_->scene).front();
        fmt::print("{} frames: at most {:.1f} MB and {} files; {} tiles read, {} failed\n", count,
                   beyond_before * 1e-6, std::max(files_at_first, files_later), stats.read,
                   stats.failed);
    }
    /// What has failed is tried again after a while.
    bool comes_back_to(const Image& picture) {
        for (int i = 0; i < 3000; ++i) {
            if (picture_at_rest() == picture) {
                return true;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return false;
    }

    /// One file vanishes, returns, is cut, or is nonsense.
    void harm(std::mt19937& random) {
        const std::string& name = names_[random() % names_.size()];
        const fs::path file = path("tiles/" + name);
        switch (random() % 5) {
        case 0:
            fs::remove(file);
            break;
        case 1:
            fs::resize_file(whole_again(name), 1'000'000);
            break;
        case 2:
            folder_.write("tiles/" + name, "no terrain");
            break;
        default: // as often as all of these
            whole_again(name);
        }
    }
    fs::path whole_again(const std::string& name) const {
        const fs::path file = path("tiles/" + name);
        fs::copy_file(path("whole/" + name), file, fs::copy_options::overwrite_existing);
        return file;
    }

    std::vector<std::string> names_;
    std::optional<session::TerrainScene> scene_;
    KeptLog log_;
    std::size_t before_ = 0; // bytes of the process
    std::optional<test::EnvironmentVariable> cache_;
};

// Memory is counted beyond that of the process before it read the terrain.
TEST_F(Soak, FilesThatComeAndGoCostNoMemoryNoDescriptorsAndNoPicture) {
    RELJEF_RELEASE_ONLY("counts memory and takes long");
    open(path("tiles"), memory_megabytes);
    const Image first = picture_at_rest();
    std::mt19937 random(7);
    fly([&](int frame) {
        if (frame % 5 == 0) {
            harm(random);
        }
    });
    for (const std::string& name : names_) {
        whole_again(name);
    }
    EXPECT_TRUE(comes_back_to(first));
    int named = 0;
    for (const std::string& name : names_) {
        named += log_.all().find(name) != std::string::npos ? 1 : 0;
    }
    EXPECT_GE(named, 1);
    EXPECT_EQ(static_cast<std::size_t>(named), session::failed_files(scene_->scene));
}

TEST_F(Soak, AServerThatFailsAndLiesCostsNoMemoryNoDescriptorsAndNoPicture) {
    RELJEF_RELEASE_ONLY("counts memory and takes long");
    RELJEF_NEED_NGINX();
    const auto made = test::run_program(
        "/usr/bin/gdal_translate", {"-q", "-of", "COG", "-co", "BLOCKSIZE=128", "-co",
                                    "COMPRESS=NONE", path("tiles/N44E006.hgt"), path("dem.tif")});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    fs::copy(path("dem.tif"), path("dem_whole.tif"));
    const test::EnvironmentVariable retries("GDAL_HTTP_MAX_RETRY", "0");
    const test::EnvironmentVariable patience("GDAL_HTTP_LOW_SPEED_TIME", "1");
    test::Nginx server(folder_.path());
    open(server.url("dem.tif"), 2);
    const Image first = picture_at_rest();
    std::mt19937 random(11);
    const std::array<std::string, 6> rules{"",
                                           "location / { return 404; }",
                                           "location / { return 500; }",
                                           "location / { return 444; }",
                                           "limit_rate 1k;",
                                           test::remembered_lengths};
    fly([&](int frame) {
        if (frame % 50 != 0) {
            return;
        }
        fs::copy_file(path("dem_whole.tif"), path("dem.tif"), fs::copy_options::overwrite_existing);
        const std::string& rule = rules.at(random() % rules.size());
        server.serve_by(rule);
        if (rule == test::remembered_lengths) {
            fs::resize_file(path("dem.tif"), 1'000'000);
        }
    });
    fs::copy_file(path("dem_whole.tif"), path("dem.tif"), fs::copy_options::overwrite_existing);
    server.serve_by("");
    EXPECT_TRUE(comes_back_to(first));
}

} // namespace
} // namespace reljef
