// Frames and tiles that several processes share.
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "engine/io/image/image.h"
#include "tests/app/command_line.h"
#include "tests/session/made_waves.h"
#include "tests/support/temporary_folder.h"

namespace reljef {
namespace {

namespace fs = std::filesystem;

constexpr int frames = 7;

class Shards : public testing::Test {
protected:
    [[nodiscard]] test::ProgramResult run(const std::vector<std::string>& arguments,
                                          test::ProgramOptions options = {}) const {
        options.environment["XDG_CACHE_HOME"] = (folder_.path() / "cache").string();
        return test::reljef(arguments, options);
    }
    [[nodiscard]] std::vector<std::string> flight(const std::string& name,
                                                  const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments{"render",   natural_, "--path",    "flyover",
                                           "--frames", "7",      "--context", "cpu",
                                           "--size",   size_,    "-o"};
        arguments.push_back((folder_.path() / name / ("%02d" + extension_)).string());
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    }
    void expect_drawn(const test::ProgramResult& result) const {
        EXPECT_EQ(result.exit_code, 0) << result.err;
    }
    [[nodiscard]] std::string picture(const std::string& name, int index) const {
        return test::read_bytes(folder_.path() / name / file(index));
    }
    [[nodiscard]] std::string file(int index) const {
        return "0" + std::to_string(index) + extension_;
    }
    void expect_same_pictures(const std::string& a, const std::string& b) const {
        for (int index = 0; index < frames; ++index) {
            EXPECT_FALSE(picture(a, index).empty()) << index;
            EXPECT_EQ(picture(a, index), picture(b, index)) << index;
        }
    }
    /// Damages some pictures of a whole flight and draws them again.
    void expect_damage_is_found() {
        expect_drawn(run(flight("whole")));
        const fs::path parts = folder_.path() / "parts";
        fs::copy(folder_.path() / "whole", parts);
        const std::string whole = picture("whole", 2);
        const auto write = [&](int index, const std::string& bytes) {
            folder_.write("parts/" + file(index), bytes);
        };
        fs::remove(parts / file(1));
        write(2, whole.substr(0, whole.size() / 2));
        write(3, "");
        ASSERT_TRUE(io::write_image(parts / file(4), Image(63, 48)));
        std::string flipped = picture("whole", 6);
        flipped[2 * flipped.size() / 3] = static_cast<char>(flipped[2 * flipped.size() / 3] ^ 1);
        write(6, flipped);
        const auto kept = fs::last_write_time(parts / file(5));
        expect_drawn(run(flight("parts", {"--resume"})));
        expect_same_pictures("whole", "parts");
        EXPECT_EQ(fs::last_write_time(parts / file(5)), kept);
    }
    std::string extension_ = ".png";
    std::string size_ = "64x48";
    test::TemporaryFolder folder_;
    std::string natural_ = test::small_terrain(folder_, "natural");
};

TEST_F(Shards, FramesOfAllPartsAreThoseOfOneProcess) {
    expect_drawn(run(flight("whole")));
    for (const char* part : {"0/3", "1/3", "2/3"}) {
        expect_drawn(run(flight("parts", {"--shard", part})));
    }
    expect_same_pictures("whole", "parts");
}

TEST_F(Shards, APartDrawsItsFramesOnly) {
    expect_drawn(run(flight("part", {"--shard", "1/3"})));
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_.path() / "part")) {
        names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    EXPECT_EQ(names, (std::vector<std::string>{"01.png", "04.png"}));
    expect_drawn(run(flight("none", {"--shard", "8/9", "--stats"})));
    EXPECT_TRUE(fs::is_empty(folder_.path() / "none")) << "more parts than frames";
}

TEST_F(Shards, AKilledWorkersPartIsCompletedByASecondRun) {
    size_ = "640x480"; // the rest takes longer than the kill
    expect_drawn(run(flight("whole")));
    expect_drawn(run(flight("parts", {"--shard", "0/2"})));
    const fs::path first = folder_.path() / "parts" / "01.png";
    test::ProgramOptions killed;
    killed.interruption = {SIGKILL, [&](int) { return fs::exists(first); }};
    const auto result = run(flight("parts", {"--shard", "1/2"}), killed);
    EXPECT_EQ(result.exit_code, 128 + SIGKILL);
    const auto time = fs::last_write_time(first);
    expect_drawn(run(flight("parts", {"--shard", "1/2", "--resume"})));
    expect_same_pictures("whole", "parts");
    EXPECT_EQ(fs::last_write_time(first), time) << "it was complete";
}

TEST_F(Shards, ResumeDrawsMissingDamagedAndSmallerPicturesAgain) {
    expect_damage_is_found();
}

TEST_F(Shards, ResumeFindsDamageInFormatsWithoutChecksums) {
    for (const char* extension : {".jpg", ".tif"}) {
        extension_ = extension;
        expect_damage_is_found();
        fs::remove_all(folder_.path() / "whole");
        fs::remove_all(folder_.path() / "parts");
    }
}

TEST_F(Shards, OnlyNumberedPicturesHaveParts) {
    const std::string hits = (folder_.path() / "h.exr").string();
    const auto refused = [&](std::vector<std::string> more, const std::string& found) {
        std::vector<std::string> arguments{"render", "natural"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        test::expect_refusal(run(arguments), 2, {found});
    };
    refused({"-o", "a.png", "--shard", "0/2"}, "--shard: 'a.png' found");
    refused({"-o", "a.mp4", "--path", "orbit", "--frames", "9", "--resume"},
            "--resume: 'a.mp4' found");
    refused({"-o", "%d.bmp", "--path", "orbit", "--frames", "9", "--resume"},
            "--resume: '%d.bmp' found as -o, .png, .jpg or .tif");
    refused({"-o", "%d.png", "--contact-sheet", "s.png", "--shard", "0/2"}, "--contact-sheet");
    refused({"-o", "%d.png", "--hit", hits, "--resume"}, "--hit");
    refused({"-o", "%d.png", "--shard", "2/2"}, "'2/2' found");
    refused({"-o", "%d.png", "--shard", "auto"}, "none of $SLURM_PROCID");
}

// Streams of tiles keep what earlier frames read; a picture must not depend on it.
TEST_F(Shards, StreamedFramesOfAllPartsAreThoseOfOneProcess) {
    test::write_waves(folder_.path() / "waves.tif", 700, 700);
    const auto draw = [&](const std::string& name, const std::vector<std::string>& more) {
        std::vector<std::string> arguments{
            "render",      (folder_.path() / "waves.tif").string(),
            "--path",      "flyover",
            "--frames",    "7",
            "--size",      "64x48",
            "--memory",    "2",
            "--context",   "osmesa",
            "--max-error", "1",
            "-o",          (folder_.path() / name / "%02d.png").string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run(arguments);
    };
    std::vector<std::jthread> workers;
    for (const char* part : {"0/3", "1/3", "2/3"}) {
        workers.emplace_back([&, part] { expect_drawn(draw("parts", {"--shard", part})); });
    }
    workers.clear(); // they make one index together
    expect_drawn(draw("whole", {}));
    expect_same_pictures("whole", "parts");
}

TEST_F(Shards, PartsOfAnIndexMakeTheIndexOfOneProcess) {
    test::write_waves(folder_.path() / "waves.tif", 2100, 1100); // six chunks
    const std::string waves = (folder_.path() / "waves.tif").string();
    const auto index = [&](const std::string& cache, std::vector<std::string> more) {
        test::ProgramOptions options;
        options.environment["XDG_CACHE_HOME"] = (folder_.path() / cache).string();
        more.insert(more.begin(), {"index", waves, "--memory", "1"});
        return test::reljef(more, options);
    };
    const auto bytes = [&](const std::string& cache) {
        for (const auto& entry : fs::directory_iterator(folder_.path() / cache / "reljef")) {
            if (entry.path().extension() == ".index" &&
                !entry.path().filename().string().starts_with("tiles-")) {
                return test::read_bytes(entry.path());
            }
        }
        return std::string();
    };
    EXPECT_EQ(index("whole", {}).exit_code, 0);
    const auto first = index("parts", {"--shard", "0/2"});
    EXPECT_EQ(first.exit_code, 0) << first.err;
    EXPECT_NE(first.err.find("part 0/2 is done"), std::string::npos) << first.err;
    EXPECT_NE(bytes("parts"), bytes("whole"));
    const auto last = index("parts", {"--shard", "1/2"});
    EXPECT_EQ(last.exit_code, 0) << last.err;
    EXPECT_NE(last.out.find(" 0 unproven"), std::string::npos) << last.out;
    EXPECT_EQ(bytes("parts"), bytes("whole"));
    std::vector<std::jthread> workers;
    for (const char* part : {"0/3", "1/3", "2/3"}) {
        workers.emplace_back([&, part] {
            const auto result = index("together", {"--shard", part});
            EXPECT_EQ(result.exit_code, 0) << result.err;
        });
    }
    workers.clear();
    EXPECT_EQ(bytes("together"), bytes("whole"));
}

TEST_F(Shards, MpirunGivesEachProcessItsPart) {
    const fs::path mpirun = "/usr/bin/mpirun";
    if (!fs::exists(mpirun)) {
        GTEST_SKIP() << "openmpi-bin is not installed";
    }
    expect_drawn(run(flight("whole")));
    std::vector<std::string> arguments{"--allow-run-as-root", "--oversubscribe", "-n", "4",
                                       RELJEF_BINARY};
    const auto own = flight("parts", {"--shard", "openmpi", "--threads", "1"});
    arguments.insert(arguments.end(), own.begin(), own.end());
    test::ProgramOptions options;
    options.environment["XDG_CACHE_HOME"] = (folder_.path() / "cache").string();
    options.environment["HOME"] = folder_.path().string();
    const auto result = test::run_program(mpirun, arguments, options);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    expect_same_pictures("whole", "parts");
}

// The third of four workers is killed before it draws.
TEST_F(Shards, UnderSlurmASecondRunCompletesAKilledWorkersPart) {
    if (!fs::exists("/usr/sbin/slurmctld") || !fs::exists("/usr/sbin/slurmd")) {
        GTEST_SKIP() << "slurm-wlm is not installed";
    }
    expect_drawn(run(flight("whole")));
    const auto srun = [&](const std::string& slurm, const std::string& script) {
        std::vector<std::string> arguments{(folder_.path() / slurm).string(),
                                           "srun",
                                           "--kill-on-bad-exit=0",
                                           "-n",
                                           "4",
                                           "sh",
                                           "-c",
                                           script,
                                           RELJEF_BINARY};
        const auto own = flight("parts", {"--shard", "slurm", "--threads", "1", "--resume"});
        arguments.insert(arguments.end(), own.begin(), own.end());
        test::ProgramOptions options;
        options.environment["XDG_CACHE_HOME"] = (folder_.path() / "cache").string();
        return test::run_program(RELJEF_WITH_SLURM, arguments, options);
    };
    const auto killed = srun("s1", R"([ "$SLURM_PROCID" = 2 ] && kill -9 $$; exec "$0" "$@")");
    EXPECT_NE(killed.exit_code, 0);
    const auto again = srun("s2", R"(exec "$0" "$@")");
    EXPECT_EQ(again.exit_code, 0) << again.err;
    expect_same_pictures("whole", "parts");
}

} // namespace
} // namespace reljef
