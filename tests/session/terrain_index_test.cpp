#include "engine/session/terrain_index.h"

#include <array>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/index/index_pass.h"
#include "engine/session/streaming.h"
#include "tests/session/made_session.h"
#include "tests/session/made_waves.h"
#include "tests/support/nginx.h"
#include "tests/support/plain_permissions.h"
#include "tests/support/process_state.h"
#include "tests/support/temporary_folder.h"

namespace reljef::session {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Keeps notes, and the labels and fractions of tasks.
class KeptLog : public Log {
public:
    void message(MessageKind /*kind*/, std::string_view sentence) override {
        notes.emplace_back(sentence);
    }
    std::unique_ptr<Task> start(const std::string& label) override {
        struct KeptTask : Task {
            explicit KeptTask(KeptLog& kept) : log(kept) {}
            void update(double fraction) override {
                ++log.updates;
                log.act(fraction);
            }
            KeptLog& log;
        };
        tasks.push_back(label);
        return std::make_unique<KeptTask>(*this);
    }
    std::vector<std::string> notes;
    std::vector<std::string> tasks;
    int updates = 0;
    std::function<void(double)> act = [](double) {};
};

/// 2300×90 samples, three chunks, of which 1 MB cannot hold all.
class TerrainIndex : public testing::Test {
protected:
    void SetUp() override {
        test::write_waves(file(), 2300, 90);
        choice_.terrain = file().string();
        choice_.memory_megabytes = 1;
        choice_.streamed = true;
    }
    [[nodiscard]] fs::path file() const { return folder_.path() / "waves.tif"; }
    [[nodiscard]] fs::path cache() const { return folder_.path() / "cache"; }
    [[nodiscard]] std::vector<fs::path> indexes() const {
        std::vector<fs::path> files;
        std::error_code ignored;
        for (const auto& entry : fs::directory_iterator(cache() / "reljef", ignored)) {
            if (entry.path().extension() == ".index") {
                files.push_back(entry.path());
            }
        }
        return files;
    }
    [[nodiscard]] TerrainSource opened() const {
        auto source = test::open_terrain(choice_);
        EXPECT_TRUE(source && source->stream) << (source ? "in memory" : source.error().message);
        return std::move(*source);
    }
    /// Opens the scene; its stream.
    std::shared_ptr<scene::TileStream> stream_of(IndexUse index, const SceneOptions& view) {
        choice_.index = index;
        scene_.emplace(open_scene(choice_, view, log_));
        EXPECT_TRUE(*scene_) << (*scene_ ? "" : scene_->error().message);
        return (*scene_)->terrain->get<scene::TerrainNode>()->stream;
    }
    /// The note on a terrain that cannot be indexed, and is drawn without proofs.
    std::string reason() {
        TerrainSource source = opened();
        log_.notes.clear();
        EXPECT_TRUE(add_proofs(source, true, log_, {}));
        EXPECT_EQ(source.proofs, nullptr);
        EXPECT_EQ(log_.notes.size(), 1U);
        return log_.notes.empty() ? "" : log_.notes.front();
    }
    [[nodiscard]] io::IndexSource index_source_of(const TerrainSource& source) const {
        auto index = io::index_source(*source.tiles, source.stream->plan.grid, source.stream->gaps,
                                      cache() / "reljef");
        EXPECT_TRUE(index) << index.error().message;
        return std::move(*index);
    }

    /// Makes all samples of the first chunk equal in the index.
    static void write_nonsense(const io::IndexSource& source, float height) {
        auto index = io::ErrorIndex::open_to_write(source);
        ASSERT_TRUE(index);
        const auto flat = [=](int, std::span<float> row) {
            std::fill(row.begin(), row.end(), height);
        };
        ASSERT_TRUE(index->write({0, 0, 0}, terrain::prove_chunk(source.tree, {0, 0, 0}, {flat})));
    }

    test::TemporaryFolder folder_;
    test::EnvironmentVariable variable_{"XDG_CACHE_HOME", cache().string()};
    SourceOptions choice_;
    KeptLog log_;
    std::optional<Result<TerrainScene>> scene_;
};

SceneOptions bounded() {
    SceneOptions view;
    view.max_error = 1.0;
    return view;
}

scene::TileContent read(const scene::TileStream& stream, terrain::TreeTile tile) {
    return stream.reader()(tile, {});
}

TEST_F(TerrainIndex, IsMadeForANamedBoundOnceAndUsedByAll) {
    EXPECT_FALSE(stream_of(IndexUse::made, {})->options().find_proof) << "a default bound";
    EXPECT_FALSE(stream_of(IndexUse::existing, bounded())->options().find_proof);
    EXPECT_THAT(indexes(), IsEmpty());
    const auto made = stream_of(IndexUse::made, bounded());
    EXPECT_THAT(log_.tasks, testing::Contains("indexing waves.tif"));
    ASSERT_TRUE(made->options().find_proof);
    EXPECT_TRUE(made->options().find_proof(made->tree().root()));
    EXPECT_TRUE(read(*made, made->tree().root()).is_proven);
    EXPECT_TRUE(read(*made, {0, 17, 0}).is_proven);
    log_.tasks.clear();
    EXPECT_TRUE(stream_of(IndexUse::made, bounded())->options().find_proof);
    EXPECT_TRUE(stream_of(IndexUse::existing, {})->options().find_proof);
    EXPECT_THAT(log_.tasks, testing::Not(testing::Contains("indexing waves.tif")));
    const auto none = stream_of(IndexUse::none, bounded());
    EXPECT_FALSE(none->options().find_proof);
    EXPECT_FALSE(read(*none, none->tree().root()).is_proven);
}

TEST_F(TerrainIndex, OfATechniqueWithAnErrorIsMadeToo) {
    SceneOptions view;
    view.technique = scene::parse_technique("polygons:error=2").value();
    EXPECT_TRUE(stream_of(IndexUse::made, view)->options().find_proof);
}

TEST_F(TerrainIndex, InterruptedGoesOnWhereItStopped) {
    choice_.memory_megabytes = 1; // one thread
    std::stop_source stop;
    log_.act = [&](double fraction) {
        if (fraction < 0.5) {
            stop.request_stop();
        }
    };
    TerrainSource source = opened();
    EXPECT_FALSE(add_proofs(source, true, log_, stop.get_token()));
    EXPECT_EQ(source.proofs, nullptr);
    EXPECT_EQ(log_.updates, 1) << "one chunk of three";
    ASSERT_EQ(indexes().size(), 1U);
    // As it is, it proves what it has.
    ASSERT_TRUE(add_proofs(source, false, log_, {}));
    ASSERT_NE(source.proofs, nullptr);
    EXPECT_TRUE(source.proofs->find({0, 0, 0}));
    EXPECT_FALSE(source.proofs->find({0, 17, 0}));
    EXPECT_TRUE(source.proofs->read({0, 0, 0}, {}));
    EXPECT_FALSE(source.proofs->read({0, 17, 0}, {}));
    log_.act = [](double) {};
    log_.updates = 0;
    ASSERT_TRUE(add_proofs(source, true, log_, {}));
    EXPECT_EQ(log_.updates, 2);
    EXPECT_TRUE(source.proofs->is_complete());
}

TEST_F(TerrainIndex, OfAnotherStateIsNotUsedAndNoted) {
    ASSERT_TRUE(stream_of(IndexUse::made, bounded())->options().find_proof);
    fs::last_write_time(file(), fs::last_write_time(file()) + std::chrono::hours(1));
    log_.notes.clear();
    EXPECT_FALSE(stream_of(IndexUse::existing, {})->options().find_proof);
    EXPECT_THAT(log_.notes, testing::Contains(HasSubstr("present state of")).Times(1));
    log_.notes.clear();
    EXPECT_TRUE(stream_of(IndexUse::made, bounded())->options().find_proof) << "made anew";
    EXPECT_THAT(log_.notes, testing::Not(testing::Contains(HasSubstr("present state of"))));
}

TEST_F(TerrainIndex, WithDamagedProofsIsReportedAndMadeAnew) {
    ASSERT_TRUE(stream_of(IndexUse::made, bounded())->options().find_proof);
    constexpr std::streamoff header = 48;
    {
        std::fstream index(indexes().front(), std::ios::in | std::ios::out | std::ios::binary);
        index.seekp(header);
        index.write(std::string(100, '\0').data(), 100);
    }
    log_.notes.clear();
    log_.tasks.clear();
    const auto stream = stream_of(IndexUse::made, bounded());
    EXPECT_THAT(log_.notes, testing::Contains(HasSubstr("damaged parts")).Times(1));
    EXPECT_THAT(log_.tasks, testing::Contains("indexing waves.tif"));
    EXPECT_TRUE(stream->options().find_proof({0, 0, 0}));
    log_.notes.clear();
    ASSERT_TRUE(stream_of(IndexUse::made, bounded()));
    EXPECT_THAT(log_.notes, testing::Not(testing::Contains(HasSubstr("damaged parts"))));
}

// All proofs may be left, and the heights of coarse tiles be gone.
TEST_F(TerrainIndex, ThatIsCutIsReportedAndMadeAnew) {
    ASSERT_TRUE(stream_of(IndexUse::made, bounded())->options().find_proof);
    const auto size = fs::file_size(indexes().front());
    for (const std::uintmax_t cut : {size - 1, size / 2, size / 20}) {
        fs::resize_file(indexes().front(), cut);
        log_.notes.clear();
        ASSERT_TRUE(stream_of(IndexUse::made, bounded()));
        EXPECT_THAT(log_.notes, testing::Contains(HasSubstr("damaged parts")).Times(1)) << cut;
        EXPECT_EQ(fs::file_size(indexes().front()), size);
        log_.notes.clear();
        ASSERT_TRUE(stream_of(IndexUse::made, bounded()));
        EXPECT_THAT(log_.notes, testing::Not(testing::Contains(HasSubstr("damaged parts"))));
    }
}

TEST_F(TerrainIndex, OfNonsenseIsReportedOnceAndTheTilesAreRight) {
    ASSERT_TRUE(stream_of(IndexUse::made, bounded()));
    const io::IndexSource source = index_source_of(opened());
    write_nonsense(source, 5.0F);
    const auto stream = stream_of(IndexUse::existing, {});
    const std::array<terrain::TreeTile, 2> tiles{{{0, 0, 0}, {1, 1, 0}}};
    stream->request(tiles);
    ASSERT_TRUE(stream->wait({}));
    for (const terrain::TreeTile tile : tiles) {
        const auto found = stream->find(tile);
        ASSERT_NE(found, nullptr);
        EXPECT_FALSE(found->of_overview);
        EXPECT_GT(found->heightfield.heights(0, 0), 500.0F);
        EXPECT_FALSE(stream->options().find_proof(tile));
    }
    EXPECT_EQ(failed_files((*scene_)->scene), 1U) << "for the exit status";
    EXPECT_THAT(stream->take_errors(), ElementsAre(HasSubstr(source.file.string() + ": tile")));
    EXPECT_LE(stream->stats().failed, 2) << "read again once";
}

TEST_F(TerrainIndex, OfNonsenseEndsTheProofsOfTilesThatWereLoadedBefore) {
    ASSERT_TRUE(stream_of(IndexUse::made, bounded()));
    write_nonsense(index_source_of(opened()), test::height_of_waves(9, 9));
    const auto stream = stream_of(IndexUse::existing, {});
    const terrain::TreeTile root = stream->tree().root();
    const terrain::TreeTile unread{2, 7, 0};
    const std::array<terrain::TreeTile, 1> whole{root};
    stream->request(whole);
    ASSERT_TRUE(stream->wait({}));
    EXPECT_TRUE(stream->find(root)->is_proven);
    EXPECT_TRUE(stream->recall(unread));
    const std::uint64_t revision = stream->revision();
    const std::array<terrain::TreeTile, 1> wrong{{{0, 0, 0}}};
    stream->request(wrong);
    ASSERT_TRUE(stream->wait({}));
    EXPECT_FALSE(stream->find(wrong[0])->is_proven);
    EXPECT_FALSE(stream->find(root)) << "is read again";
    EXPECT_FALSE(stream->recall(unread));
    EXPECT_GT(stream->revision(), revision + 1) << "more than a tile that arrived";
    stream->request(whole);
    ASSERT_TRUE(stream->wait({}));
    EXPECT_FALSE(stream->find(root)->is_proven);
}

// Its range would hide the tile, so that no sample of it is ever read.
TEST_F(TerrainIndex, HeightsBeyondThoseOfTheCoarserTileAreAContradiction) {
    ASSERT_TRUE(stream_of(IndexUse::made, bounded()));
    const io::IndexSource source = index_source_of(opened());
    write_nonsense(source, 9e5F);
    const auto stream = stream_of(IndexUse::existing, {});
    EXPECT_TRUE(stream->recall({3, 4, 0}));
    EXPECT_FALSE(stream->recall({3, 0, 0})) << "not proven";
    const std::array<terrain::TreeTile, 1> tiles{{{3, 0, 0}}};
    stream->request(tiles);
    ASSERT_TRUE(stream->wait({}));
    EXPECT_LT(stream->find(tiles[0])->range.high, 1300.0);
    EXPECT_THAT(stream->take_errors(), ElementsAre(HasSubstr("coarser tile")));
}

TEST_F(TerrainIndex, ErrorsOfTheSourceAreThoseOfItsFiles) {
    ASSERT_TRUE(stream_of(IndexUse::made, bounded()));
    const auto stream = stream_of(IndexUse::existing, {});
    const auto time = fs::last_write_time(file());
    fs::resize_file(file(), 100);
    fs::last_write_time(file(), time);
    const auto content = read(*stream, {0, 17, 0});
    EXPECT_FALSE(content.is_proven);
    EXPECT_TRUE(content.of_overview);
    ASSERT_EQ(content.picture_errors.size(), 1U);
    EXPECT_THAT(content.picture_errors.front().file, HasSubstr("waves.tif"));
    EXPECT_TRUE(read(*stream, stream->tree().root()).is_proven) << "stored in the index";
}

TEST_F(TerrainIndex, WithoutACacheFolderANoteSaysWhy) {
    const test::EnvironmentVariable no_cache("XDG_CACHE_HOME", "");
    const test::EnvironmentVariable no_home("HOME", "");
    EXPECT_THAT(reason(), HasSubstr("no absolute path found"));
}

TEST_F(TerrainIndex, InAFolderThatCannotBeWrittenANoteSaysWhy) {
    fs::create_directories(cache() / "reljef");
    fs::permissions(cache() / "reljef", fs::perms::owner_read | fs::perms::owner_exec);
    const test::PlainPermissions plain;
    EXPECT_THAT(reason(), HasSubstr("Permission denied"));
}

TEST_F(TerrainIndex, OnAFullDiskANoteSaysWhy) {
    const TerrainSource source = opened();
    const test::FileSizeLimit limit(4096);
    EXPECT_THAT(reason(), HasSubstr("cannot be written"));
}

TEST_F(TerrainIndex, WaitsForAnotherProcessThatWritesIt) {
    fs::create_directories(cache() / "reljef");
    TerrainSource source = opened();
    std::optional<io::ErrorIndex> other;
    {
        auto opened = io::ErrorIndex::open_to_write(index_source_of(source));
        ASSERT_TRUE(opened) << opened.error().message;
        other.emplace(std::move(*opened));
    }
    std::atomic<bool> is_done{false};
    std::jthread waiting([&] {
        EXPECT_TRUE(add_proofs(source, true, log_, {}));
        is_done = true;
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(100)); // a chance to fail
    EXPECT_FALSE(is_done);
    other.reset();
    waiting.join();
    EXPECT_NE(source.proofs, nullptr);
}

TEST_F(TerrainIndex, AStopEndsTheWaitForAnotherProcess) {
    fs::create_directories(cache() / "reljef");
    TerrainSource source = opened();
    const auto other = io::ErrorIndex::open_to_write(index_source_of(source));
    ASSERT_TRUE(other) << other.error().message;
    std::stop_source stop;
    std::jthread stopping([&] { stop.request_stop(); });
    EXPECT_FALSE(add_proofs(source, true, log_, stop.get_token()));
}

TEST_F(TerrainIndex, IsNotMadeOfAllThatAServerHas) {
    RELJEF_NEED_NGINX();
    const test::Nginx server(folder_.path());
    choice_.terrain = server.url("waves.tif");
    TerrainSource source = opened();
    const std::size_t before = server.bytes_sent();
    ASSERT_TRUE(add_proofs(source, true, log_, {}));
    EXPECT_EQ(source.proofs, nullptr);
    EXPECT_THAT(log_.notes, testing::Contains(HasSubstr("on a server")));
    EXPECT_LT(server.bytes_sent() - before, fs::file_size(file()) / 2);
    EXPECT_THAT(indexes(), IsEmpty());
}

} // namespace
} // namespace reljef::session
