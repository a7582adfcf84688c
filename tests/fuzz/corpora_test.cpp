// The committed inputs of all targets: what was found once stays fixed.
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/fuzz_targets.h"

namespace reljef::fuzz {
namespace {

namespace fs = std::filesystem;

struct Target {
    std::string name;
    void (*run)(std::string_view input);
};

const std::vector<Target>& targets() {
    static const std::vector<Target> all{{"bookmarks", bookmarks_target},
                                         {"cache", cache_target},
                                         {"error_index", error_index_target},
                                         {"flight", flight_target},
                                         {"footprints", footprints_target},
                                         {"geoid", geoid_target},
                                         {"hits", hits_target},
                                         {"imagery", imagery_target},
                                         {"mesh", mesh_target},
                                         {"picture", picture_target},
                                         {"place", place_target},
                                         {"ramp", ramp_target},
                                         {"raster", raster_target},
                                         {"results", results_target},
                                         {"scene", scene_target},
                                         {"texture", texture_target},
                                         {"tile_index", tile_index_target},
                                         {"web_tile", web_tile_target}};
    return all;
}

std::vector<fs::path> entries_of(const fs::path& folder) {
    std::vector<fs::path> entries;
    for (const auto& entry : fs::directory_iterator(folder)) {
        entries.push_back(entry.path());
    }
    std::sort(entries.begin(), entries.end());
    return entries;
}

std::string bytes_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return (std::ostringstream() << file.rdbuf()).str();
}

class Corpora : public ::testing::TestWithParam<Target> {};

TEST_P(Corpora, EachInputIsReadOrRefused) {
    const auto inputs = entries_of(fs::path(RELJEF_CORPORA) / GetParam().name);
    EXPECT_FALSE(inputs.empty());
    for (const fs::path& input : inputs) {
        EXPECT_NO_THROW(GetParam().run(bytes_of(input))) << input;
    }
}

INSTANTIATE_TEST_SUITE_P(Targets, Corpora, ::testing::ValuesIn(targets()),
                         [](const auto& instance) { return instance.param.name; });

TEST(CorporaTest, EachTargetHasInputsAndAllInputsHaveATarget) {
    std::vector<std::string> names;
    for (const Target& target : targets()) {
        names.push_back(target.name);
    }
    std::vector<std::string> folders;
    for (const fs::path& folder : entries_of(RELJEF_CORPORA)) {
        folders.push_back(folder.filename().string());
    }
    EXPECT_EQ(names, folders);
}

TEST(CorporaTest, APropertyThatDoesNotHoldIsAFinding) {
    EXPECT_THROW(expect(false, "a property"), Finding);
    EXPECT_NO_THROW(expect(true, "a property"));
}

} // namespace
} // namespace reljef::fuzz
