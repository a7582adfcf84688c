// Each call of ours that allocates, opens, reads or writes fails once in turn, and the power is
// lost before each change of a file. RELJEF_ALL_FAULTS=1 tries all call sites; without it all of a
// picture's files, and a few of the others, evenly spread.
#include <algorithm>
#include <cstdlib>
#include <limits>
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/faults/faulty_run.h"

namespace reljef::test {
namespace {

using Arguments = std::vector<std::string>;

Arguments picture_with_hits() {
    return {"render",   "dem.bil", "--context", "cpu",   "--size",          "64x48",
            "-o",       "a.png",   "--hit",     "a.exr", "--contact-sheet", "s.png",
            "--memory", "1",       "--threads", "2",     "--quiet"};
}

Arguments short_flight() {
    return {"render",   "dem.bil",  "--context", "cpu", "--size",   "64x48",           "--path",
            "flyover",  "--frames", "3",         "-o",  "f/%d.png", "--contact-sheet", "s.png",
            "--memory", "1",        "--threads", "2",   "--quiet"};
}

struct Site {
    std::string kind;
    std::string key;
};

/// Sorted, so that shards of one build have the same.
std::vector<Site> sites_of(const Arguments& arguments) {
    const FaultyRun run(arguments, {{"RELJEF_FAULT_LIST", "told"}});
    EXPECT_EQ(run.result().exit_code, 0) << run.result().err;
    std::vector<Site> sites;
    for (const std::string& line : run.told()) {
        std::istringstream words(line);
        Site site;
        words >> site.kind >> site.key;
        sites.push_back(site);
    }
    std::sort(sites.begin(), sites.end(),
              [](const Site& a, const Site& b) { return a.key < b.key; });
    return sites;
}

std::vector<std::string> lines_without_notes(const std::string& text) {
    std::istringstream lines(text);
    std::vector<std::string> found;
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with("reljef: note: ")) {
            found.push_back(line);
        }
    }
    return found;
}

/// Whether all files are of one of two states.
bool are_of(const FileContents& files, const FileContents& before, const FileContents& after) {
    return std::ranges::all_of(files, [&](const auto& file) {
        const auto is_in = [&](const FileContents& state) {
            const auto found = state.find(file.first);
            return found != state.end() && found->second == file.second;
        };
        return is_in(before) || is_in(after);
    });
}

/// All outputs, or an error in one line and no part of an output.
void expect_clean(const FaultyRun& run, const FileContents& whole) {
    const ProgramResult& result = run.result();
    if (result.exit_code == 0) {
        EXPECT_TRUE(run.files() == whole) << result.err;
        return;
    }
    EXPECT_EQ(result.exit_code, 1) << result.err;
    const auto lines = lines_without_notes(result.err);
    ASSERT_EQ(lines.size(), 1U) << result.err;
    // The second one before it has its name.
    EXPECT_THAT(lines.front(), testing::AnyOf(testing::StartsWith("reljef: "),
                                              testing::StartsWith("reljef_for_faults: ")));
    EXPECT_TRUE(are_of(run.files(), {}, whole)) << result.err;
}

constexpr std::size_t all_sites = std::numeric_limits<std::size_t>::max();

/// Of `sites`, at most `count`, evenly spread.
std::vector<Site> some_of(const std::vector<Site>& sites, std::size_t count) {
    if (std::getenv("RELJEF_ALL_FAULTS") != nullptr || sites.size() <= count) {
        return sites;
    }
    std::vector<Site> some;
    for (std::size_t i = 0; i < count; ++i) {
        some.push_back(sites[i * sites.size() / count]);
    }
    return some;
}

void expect_clean_faults(const Arguments& arguments, bool of_memory, std::size_t tried) {
    const FaultyRun good(arguments, {});
    ASSERT_EQ(good.result().exit_code, 0) << good.result().err;
    std::vector<Site> sites = sites_of(arguments);
    std::erase_if(sites,
                  [&](const Site& site) { return (site.kind == "allocation") != of_memory; });
    ASSERT_GT(sites.size(), of_memory ? 300U : 20U);
    const std::vector<Site> chosen = some_of(sites, tried);
    std::size_t failed = 0;
    for (const Site& site : chosen) {
        SCOPED_TRACE(site.kind + " " + site.key);
        const FaultyRun run(arguments, {{"RELJEF_FAULT", site.key}});
        failed += run.has_failed() ? 1U : 0U;
        expect_clean(run, good.files());
    }
    // Threads decide whether some calls are made, and some are made after the main function.
    EXPECT_GE(failed, 3 * chosen.size() / 4);
}

TEST(Faults, OfFilesWhileAPictureIsDrawnLoseNothing) {
    expect_clean_faults(picture_with_hits(), false, all_sites);
}

TEST(Faults, OfMemoryWhileAPictureIsDrawnLoseNothing) {
    expect_clean_faults(picture_with_hits(), true, 8);
}

TEST(Faults, OfFilesInAFlightLoseNothing) {
    expect_clean_faults(short_flight(), false, 8);
}

TEST(Faults, OfMemoryInAFlightLoseNothing) {
    expect_clean_faults(short_flight(), true, 8);
}

int changes_of(const FaultyRun& run) {
    return run.told().empty() ? 0 : std::stoi(run.told().front());
}

// A process that ends before a change leaves what a power failure leaves if all that was renamed
// had been synced.
void expect_safe_outputs(const Arguments& arguments, const FileContents& before) {
    const FaultyRun good(arguments, {{"RELJEF_FAULT_COUNT", "told"}}, before);
    ASSERT_EQ(good.result().exit_code, 0) << good.result().err;
    ASSERT_FALSE(good.told().empty());
    EXPECT_TRUE(good.told().front().ends_with(" 0")) << "renamed without a sync";
    const int changes = changes_of(good);
    EXPECT_GT(changes, 5);
    for (int stop = 1; stop <= changes; ++stop) {
        SCOPED_TRACE(stop);
        FaultyRun run(arguments, {{"RELJEF_FAULT_STOP", std::to_string(stop)}}, before);
        EXPECT_EQ(run.result().exit_code, 9);
        FileContents outputs = run.files();
        std::erase_if(outputs, [](const auto& file) {
            return std::filesystem::path(file.first).filename().string().starts_with(".");
        });
        EXPECT_TRUE(are_of(outputs, before, good.files()));
        for (const auto& [name, content] : before) {
            EXPECT_TRUE(outputs.contains(name)) << name << " was there";
        }
        run.repeat();
        EXPECT_EQ(run.result().exit_code, 0);
        EXPECT_TRUE(run.files() == good.files());
    }
}

TEST(PowerLoss, WhileOutputsAreReplacedLeavesTheOldOnesOrTheNewOnes) {
    expect_safe_outputs(picture_with_hits(),
                        {{"a.png", "old"}, {"a.exr", "old"}, {"s.png", "old"}});
}

TEST(PowerLoss, InAFlightLeavesWholeFrames) {
    expect_safe_outputs(short_flight(), {{"f/1.png", "old"}, {"s.png", "old"}});
}

} // namespace
} // namespace reljef::test
